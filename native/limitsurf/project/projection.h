// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "limitsurf/project/ray_direction.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"
#include "limitsurf/uv/footprint.h"

namespace limitsurf {

/// The image as it falls on texels, a row for each. If the projector does not see a texel, its `st`
/// is NaN, and its footprint and weight are 0.
struct Projection {
  ImagePoints st;
  Footprints footprint;
  Eigen::VectorXd weight;  ///< 0 to 1
};

/// Bounds of z/w, which is -1 on a projector's near plane and 1 on its far plane.
struct DepthRange {
  double near = -1, far = 1;
};

struct ProjectOptions {
  /// Angles between the normal and the direction to the eye, in radians: the weight is 1 up to the
  /// first, 0 from the second on, and a cubic between. 0 <= start <= end <= pi.
  double facing_start = 1.3089969389957472, facing_end = 1.5707963267948966;
  /// Measures angles on the side of the surface that faces the eye.
  bool two_sided = false;
  /// The number of rays that test whether a texel is hidden: 1, 4 or 16.
  int samples = 1;
  /// The distance from the surface, along the normal, at which rays begin. By default it is
  /// kRayBias times the diagonal of the control mesh, and a little more for rounding.
  std::optional<double> bias;
  /// The width, 0 to 1/2 of the image, of the zone inside its borders over which the weight rises.
  double soft_edge = 0;
  /// Whether the weight ends where the image does.
  bool frame = true;
  /// The visible range of depths; without one everything in front of the eye is visible.
  std::optional<DepthRange> depth = DepthRange();
  /// From the space of the surface to world space, in which angles are measured.
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
};

/// Rays to the eye begin this far above the surface, relative to the diagonal of the control mesh:
/// a thousand times kSearchError, so that no ray hits the point at which it begins. 16 units in the
/// last place of the mesh's largest coordinate are added, for meshes far from the origin.
constexpr double kRayBias = 1e-9;

/// Projects an image onto the texels of a surface's map.
///
/// `matrix` takes the surface's coordinates to clip space, in OpenGL's convention: projection *
/// view * object. The image of (x, y, z, w) is (x/w, y/w), from -1 to 1; w is positive in front of
/// the eye, and z/w grows with the distance from it. `at` holds the locations of the centres of
/// texels, and `texel` is the size of a texel in units of the map. `occluder` searches the surface
/// that may hide texels, usually the same one; if it is null nothing is hidden. What lies in front
/// of the near plane hides nothing.
///
/// st and footprint are exact but for rounding: they come from the first derivatives of projector,
/// surface and map. Where these have no limit, or surface or map is singular, they are taken
/// kStepAside (2^-10) of the way towards the face's centre; where the map is singular there too,
/// the footprint is 0. Vectors longer than kLongestFootprint are shortened.
///
/// The weight is the product of four factors: facing; the part of the texel's parallelogram (of its
/// bounding box) that lies inside the image; the soft edge; and the part of the rays that reach the
/// eye. Rays begin at the middles of a square grid over the texel, found by first-order steps in
/// (u, v), which end at the border of the face.
///
/// Throws std::invalid_argument for a matrix that is singular or not finite, for options out of
/// range, and for a map that has other than two columns or other faces; otherwise as
/// LimitSurface::evaluate(). Cost: an evaluation of surface and map, and a ray for each sample that
/// may be visible.
Projection project(const LimitSurface& surface, const SurfaceData& map, const LocationBatch& at,
                   const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                   const SurfaceSearch* occluder, const ProjectOptions& options = {},
                   int threads = 0);

/// Throws what project() throws for these arguments.
void checkProject(const LimitSurface& surface, const SurfaceData& map,
                  const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                  const ProjectOptions& options);

struct NormalProjectOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< in world space
  RayDirection direction = RayDirection::both;
  /// From the space of the surface to that of the source.
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  /// From the space of the surface to world space, in which normals are perpendicular to the
  /// surface and distances are measured.
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
};

/// Projects from another surface, the source: rays leave the texels along the surface's normals, or
/// against them, and st is the value of the source's map at the first hit. The weight of a hit
/// is 1.
///
/// The footprint tells how st changes from texel to texel, as the ray's origin and direction
/// change. It needs second derivatives of the surface, and first derivatives of the source and of
/// both maps; where they do not exist it is taken as by project(). It is 0 where the ray is tangent
/// to the source or the source's map is singular.
///
/// Throws as project(), for a max_distance that is NaN or below 0, and for a transform that takes
/// places beyond SurfaceSearch::farthestOrigin(). Cost: an evaluation, and a ray in each direction.
Projection projectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                               const LocationBatch& at, const LimitSurface& source,
                               const SurfaceData& source_map, const SurfaceSearch& source_search,
                               const Eigen::Vector2d& texel,
                               const NormalProjectOptions& options = {}, int threads = 0);

/// Throws what projectAlongNormals() throws for these arguments.
void checkProjectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                              const LimitSurface& source, const SurfaceData& source_map,
                              const Eigen::Vector2d& texel, const NormalProjectOptions& options);

/// Whether the eye of a perspective projector is inside the surface. 26 rays leave the eye towards
/// the corners, edges and faces of a cube. The eye is inside a closed surface (every edge has two
/// faces, and no face is refused) if more than half of the rays first hit its back; it is inside an
/// open surface if all of them do. Returns false for parallel projection. Throws
/// std::invalid_argument for a matrix that is singular or not finite.
bool eyeIsInside(const LimitSurface& surface, const SurfaceSearch& search,
                 const Eigen::Matrix4d& matrix, int threads = 0);

}  // namespace limitsurf
