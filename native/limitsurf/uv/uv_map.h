// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/large_pages.h"
#include "limitsurf/progress.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Bound on the error of an inversion: the distance between the given point and the value of
/// SurfaceData::evaluate() at the location found, relative to the diagonal of the bounding box
/// around the map's values and (0, 0).
constexpr double kMapError = 1e-12;

/// Bound on the error of a margin, in texels: by how much the place of a texel in the margin may
/// lie farther from it than the nearest point of the map's image. Along curves within a face on
/// which the map folds back it is half a texel.
constexpr double kMarginError = 1. / 64;

/// A point of the plane in each row.
using PlanePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Where points of the plane lie on a surface, a row for each.
struct MapLocations {
  std::vector<Location> at;           ///< face -1 where the map does not cover the point
  std::vector<std::uint8_t> overlap;  ///< the map takes several places of the surface there
  std::vector<std::uint8_t> flipped;  ///< the map is mirrored there: its Jacobian is negative
};

/// Texels of an image, sorted by row and then by column.
struct Texels {
  LargePageVector<std::int32_t> x, y;
  LargePageVector<std::int32_t> face;
  LargePageVector<std::array<double, 2>> uv;
  LargePageVector<std::uint8_t>
      inside;  ///< the map covers the texel's centre; else the texel belongs to the margin
  LargePageVector<std::uint8_t> overlap, flipped;

  std::size_t size() const { return x.size(); }
};

struct RasterOptions {
  int width = 0, height = 0;   ///< texels, 1 to kMostTexels
  int tile_x = 0, tile_y = 0;  ///< the image covers [tile_x, tile_x + 1] x [tile_y, tile_y + 1]
  double margin = 0;           ///< in texels, 0 to kMostMargin

  static constexpr int kMostTexels = 65536;
  static constexpr int kMostTile = 1 << 20;
  static constexpr double kMostMargin = 4096;
};

/// The inverse of a UV map: the places of the surface that the map takes to points of the plane.
/// The limit of the map itself is inverted, not polygons.
///
/// If the map takes several places to a point, the place on the lowest Ptex face is returned; on
/// one face that with the lowest v, then the lowest u. Places on an edge at which the map is
/// continuous are one place. A point that is no farther from a border of the map than the error
/// counts as covered, and no point is lost on a shared edge. Faces whose image has no area cover
/// nothing.
///
/// An inverse refers to its map, which must outlive it and keep its values. All const members may
/// be called from many threads at once, and return the same bits for any number of threads.
///
/// The cost of a face is bounded, whatever its image is. On a face so stretched that its image is
/// degenerate nearly everywhere (a value of the map lies a million times as far away as the
/// others), places may be missed, and the points count as not covered by it.
///
/// Cost of making it: O(faces log faces). Memory: 100 bytes a face, several times as much around an
/// extraordinary vertex.
class UvMap {
 public:
  /// Throws std::invalid_argument if the data have other than 2 columns, and for coordinates beyond
  /// 1e36.
  explicit UvMap(const SurfaceData& map, int threads = 0);
  ~UvMap();
  UvMap(UvMap&&) noexcept;
  UvMap& operator=(UvMap&&) noexcept;

  /// The location of the centre of each texel that the map covers. The centre of texel (x, y) is
  /// tile + ((x + 1/2) / width, (y + 1/2) / height) on the map.
  ///
  /// With a margin, a texel outside whose centre is no farther than that from the map's image, in
  /// texels, gets the nearest location on the border of the image, up to kMarginError. Such texels
  /// have neither `inside` nor `overlap`.
  ///
  /// Throws std::invalid_argument for options out of range. Memory: 35 bytes for each texel of the
  /// result, meanwhile up to 64 MiB, and 6 MiB for each thread.
  Texels rasterize(const RasterOptions& options, int threads = 0,
                   const Progress& progress = {}) const;

  /// The location of each point. Throws std::invalid_argument naming the first row that is not
  /// finite, or beyond 1e150.
  MapLocations locate(const PlanePoints& points, int threads = 0) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/// Throws std::invalid_argument naming the first row that is not finite, or beyond 1e150.
void checkPoints(const PlanePoints& points);

}  // namespace limitsurf
