// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Points or directions that are read where they lie: a matrix with a row for each, or a part of
/// it.
using PointRows = Eigen::Ref<const Points>;

/// The results of searches, one row for each. Where nothing was found `at` has face -1, and all
/// else is NaN.
struct Hits {
  std::vector<Location> at;
  Points position, normal;  ///< those of LimitSurface::evaluate() at the location, to the last bit
  Eigen::VectorXd distance;
};

/// All hits of all rays: those of ray i are rows offsets[i] to offsets[i + 1] - 1, nearest first.
struct RayHits : Hits {
  std::vector<std::int64_t> offsets;
};

/// Bound on the error of a distance, relative to the diagonal of the control mesh's bounding box:
/// by how much the distance of the closest point exceeds the true minimum, and by how much a hit is
/// off the ray. Along the ray, a hit is off by at most this divided by the sine of the angle
/// between ray and surface. For rays it holds for origins within 1,000 diagonals of the mesh.
/// Closest points are found as exactly from any distance, although the rounding of a number as
/// large as the distance itself may exceed the bound. So may the rounding of a location to doubles
/// next to a vertex with many faces that is not at (0, 0) of its faces: neighbouring locations are
/// up to 2e-10 faces apart there.
constexpr double kSearchError = 1e-12;

struct ClosestOptions {
  double max_distance = std::numeric_limits<double>::infinity();
  /// No rows, or a direction for each point. With directions, a result is a point of the surface
  /// whose normal makes an angle of at most `max_angle` with the direction, and at which the
  /// distance has a local minimum. The minimum is one among the points of the same smooth sheet;
  /// boundaries and infinitely sharp edges end a sheet.
  Points facing;
  double max_angle = 1.5707963267948966;  ///< radians, 0 to pi
  /// Unless null, receives the number of patches and cores that all searches together looked into,
  /// of cores that they split, and of levels around vertices with many faces: what the cost is
  /// proportional to.
  std::int64_t* leaves = nullptr;
  /// The same of the parts of patches that they looked at: few, but on patches that are squeezed to
  /// nearly a line.
  std::int64_t* cells = nullptr;
};

struct SearchTree;

/// Closest points and ray casts on the exact limit surface, not on polygons.
///
/// A search is made for one pose of the surface. It refers to the surface, which must outlive it
/// and keep that pose. All const members may be called from many threads at once. The result for a
/// row depends neither on the number of threads nor on the other rows, to the last bit.
///
/// Cost of making it: O(faces log faces), 0.01 to 0.02 s for 10,000 quads, 0.1 s for 10,000
/// triangles. What searches need to know of a face with extraordinary vertices, about 10 us for
/// each of its Ptex faces, is made when one first comes near it; and for all of them when there
/// have been as many searches as such faces. Memory: about 150 bytes a tile, ten times as much for
/// a face with extraordinary vertices, and up to 64 MiB for patches. Searches that come near a
/// vertex with more than 16 faces keep 240 bytes for each of these and each halving of the distance
/// that they look into.
class SurfaceSearch {
 public:
  explicit SurfaceSearch(const LimitSurface& surface, int threads = 0);
  ~SurfaceSearch();
  SurfaceSearch(SurfaceSearch&&) noexcept;
  SurfaceSearch& operator=(SurfaceSearch&&) noexcept;

  /// The closest point of the whole surface to each point, boundaries, creases and corners
  /// included.
  ///
  /// The method is branch and bound over the control hulls of bicubic patches and, around
  /// extraordinary vertices, of the remaining control net. A patch is done when the distance on it
  /// is convex and Newton's iteration has found its minimum, or when no point of it can be closer.
  ///
  /// With directions, subtrees are left out by the cones around their normals, as soon as a search
  /// has looked into many patches in vain. The first such search makes the cones.
  ///
  /// Error: kSearchError. Of several points that are equally close, any one is returned. Throws
  /// std::invalid_argument naming the first row that is not finite, and for a max_distance or an
  /// angle out of range.
  Hits closest(const PointRows& points, const ClosestOptions& options = {}, int threads = 0) const;
  /// The same, in the memory of earlier hits. These must not hold the points.
  void closest(const PointRows& points, const ClosestOptions& options, Hits& hits,
               int threads = 0) const;

  /// The largest coordinate that the origin of a ray may have, and a point whose closest point is
  /// sought.
  double farthestOrigin() const;

  /// The first point at which each ray meets the surface, from either side. The distance is
  /// measured along the ray and is at least 0. A ray that touches the surface hits it, and no ray
  /// passes between two faces; a ray that misses by less than kSearchError may count as a hit, and
  /// does if the rounding of its numbers may be the reason.
  ///
  /// `directions` need not be unit vectors. Throws std::invalid_argument naming the first row that
  /// is not finite, or whose direction is 0.
  Hits rayCast(const PointRows& origins, const PointRows& directions,
               double max_distance = std::numeric_limits<double>::infinity(),
               int threads = 0) const;
  /// The same, in the memory of earlier hits. These must not hold the origins or directions.
  void rayCast(const PointRows& origins, const PointRows& directions, double max_distance,
               Hits& hits, int threads = 0) const;

  /// All points at which each ray meets the surface, sorted along the ray. Hits on faces with a
  /// common vertex count as one if their distance is less than kSearchError divided by the sine of
  /// the angle between ray and surface, or by 1e-7 if that is larger. Where a ray runs within the
  /// surface, one point at the beginning of each patch is returned.
  RayHits rayCastAll(const PointRows& origins, const PointRows& directions,
                     double max_distance = std::numeric_limits<double>::infinity(),
                     int threads = 0) const;

 private:
  std::unique_ptr<const SearchTree> data_;
};

}  // namespace limitsurf
