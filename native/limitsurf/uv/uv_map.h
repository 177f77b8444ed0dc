// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Bound on the error of an inversion: the distance between the point that was asked for and the
/// value of SurfaceData::evaluate() at the location found, relative to the diagonal of the bounding
/// box around the map's values and (0, 0).
constexpr double kMapError = 1e-12;

/// Bound on how much farther than the nearest point of the map's image the place of a texel in the
/// margin may lie, in texels; along curves within a face on which the map folds back, half a texel.
constexpr double kMarginError = 1. / 64;

/// One point of the plane per row.
using PlanePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// Where points of the plane lie on a surface, one row each.
struct MapLocations {
  std::vector<Location> at;           ///< face -1 where the map does not cover the point
  std::vector<std::uint8_t> overlap;  ///< several places of the surface lie there
  std::vector<std::uint8_t> flipped;  ///< the map is mirrored there: its Jacobian is negative
};

/// Texels of an image, sorted by row and then by column.
struct Texels {
  std::vector<std::int32_t> x, y;
  std::vector<std::int32_t> face;
  std::vector<std::array<double, 2>> uv;
  std::vector<std::uint8_t>
      inside;  ///< the map covers the texel's centre; else it is of the margin
  std::vector<std::uint8_t> overlap, flipped;

  std::size_t size() const { return x.size(); }
};

struct RasterOptions {
  int width = 0, height = 0;   ///< texels, 1 to kMostTexels
  int tile_x = 0, tile_y = 0;  ///< the image covers [tile_x, tile_x + 1] x [tile_y, tile_y + 1]
  double margin = 0;           ///< texels

  static constexpr int kMostTexels = 65536;
  static constexpr int kMostTile = 1 << 20;
  static constexpr double kMostMargin = 4096;
};

/// The inverse of a UV map: which places of the surface lie at points of the plane. The map is
/// inverted on the limit itself, not on polygons.
///
/// Where several places lie at a point, that with the lowest Ptex face is given, among those of one
/// face that with the lowest v, then u. Places on an edge that the map does not tear apart are one
/// place. A point that is no farther from a border of the map than the error counts as covered, and
/// none is lost on a shared edge. Faces whose image has no area cover nothing.
///
/// Refers to the map, which must live on and keep its values. All const members may be called from
/// many threads at once, and give the same bits whatever the number of threads.
///
/// Making it: O(faces log faces). Memory: 100 bytes a face, several times that around an
/// extraordinary vertex.
class UvMap {
 public:
  /// Throws std::invalid_argument for data of other than 2 columns, and for coordinates beyond
  /// 1e36.
  explicit UvMap(const SurfaceData& map, int threads = 0);
  ~UvMap();
  UvMap(UvMap&&) noexcept;
  UvMap& operator=(UvMap&&) noexcept;

  /// The location under the centre of each texel that the map covers. Texel (x, y)'s centre is
  /// tile + ((x + 1/2) / width, (y + 1/2) / height) on the map.
  ///
  /// With a margin, texels outside whose centre lies no farther than that from the map's image, in
  /// texels, get the location on its border that is nearest to kMarginError. They are neither
  /// inside nor overlap.
  ///
  /// Throws std::invalid_argument for options out of range. Memory: 35 bytes a texel of the result,
  /// twice for a moment, and 8 MiB a thread.
  Texels rasterize(const RasterOptions& options, int threads = 0,
                   const Progress& progress = {}) const;

  /// The location at each point. Throws std::invalid_argument naming the first row that is not
  /// finite.
  MapLocations locate(const PlanePoints& points, int threads = 0) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/// Throws std::invalid_argument naming the first row that is not finite, or beyond 1e150.
void checkPoints(const PlanePoints& points);

}  // namespace limitsurf
