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

/// Where an image falls on texels, one row each. Where nothing is seen `st` is NaN, and footprint
/// and weight are 0.
struct Projection {
  ImagePoints st;
  Footprints footprint;
  Eigen::VectorXd weight;  ///< 0 to 1
};

/// Bounds of z/w, which is -1 on a projector's near plane and 1 on its far one.
struct DepthRange {
  double near = -1, far = 1;
};

struct ProjectOptions {
  /// Angles in radians between the normal and the direction to the eye: up to the first the weight
  /// is 1, from the second on 0, with a cubic between. 0 <= start <= end <= pi.
  double facing_start = 1.3089969389957472, facing_end = 1.5707963267948966;
  /// Takes angles to the nearer of both sides.
  bool two_sided = false;
  /// 1, 4 or 16 rays a texel for what hides it.
  int samples = 1;
  /// How far from the surface, along the normal, rays begin; kRayBias times the cage's diagonal
  /// and some rounding where it is not given.
  std::optional<double> bias;
  /// Over this part of the image, 0 to 1/2, the weight rises from its borders on.
  double soft_edge = 0;
  /// Whether the weight ends where the image does.
  bool frame = true;
  /// Where nothing is given: all that is in front of the eye.
  std::optional<DepthRange> depth = DepthRange();
  /// From the surface's space to the one in which angles are measured.
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
};

/// Rays to the eye begin so far above the surface, relative to the cage's diagonal: a thousand
/// times kSearchError, so that no ray meets the place where it begins. 16 units in the last place
/// of the cage's largest coordinate come on top, for cages far from the origin.
constexpr double kRayBias = 1e-9;

/// Where a projector's image falls on texels of a surface's map.
///
/// `matrix` takes the surface's coordinates to clip space (projector.h). `at` are the locations
/// under the texels' centres, `texel` is a texel's size in the map's units. `occluder` searches
/// what hides the texels, the surface itself as a rule; null: nothing does. What is nearer than the
/// near plane hides nothing.
///
/// st and footprint are exact but for rounding: first derivatives of projector, surface and map.
/// Where those have no limit, or surface or map are singular: kStepAside (2^-10) of the way to the
/// face's centre; where the map is singular there too the footprint is 0. Vectors longer than
/// kLongestFootprint are shortened.
///
/// The weight is the product of: facing; the part of the texel's parallelogram (its bounding box)
/// that is inside the image; the soft edge; the part of the rays that reach the eye. Rays begin at
/// the middles of a square grid over the texel, found by first-order steps in (u, v), which end at
/// the border of the face.
///
/// Throws std::invalid_argument for a matrix that is not finite or singular, options without
/// meaning and a map of other columns or faces; else as LimitSurface::evaluate(). Cost: an
/// evaluation of surface and map, and one ray for each sample that may be seen.
Projection project(const LimitSurface& surface, const SurfaceData& map, Span<Location> at,
                   const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                   const SurfaceSearch* occluder, const ProjectOptions& options = {},
                   int threads = 0);

/// What project() throws for these arguments.
void checkProject(const LimitSurface& surface, const SurfaceData& map,
                  const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                  const ProjectOptions& options);

struct NormalProjectOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< in the world
  RayDirection direction = RayDirection::both;
  /// From the surface's space to the source's.
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  /// From the surface's space to the one in which normals are perpendicular to it, and distances
  /// are measured.
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
};

/// Where rays from the texels along the surface's normals, or against them, first meet another
/// surface, in that one's map: st is the source's map there, the weight 1.
///
/// The footprint is how st moves with the texel when the ray's origin and direction do: second
/// derivatives of the surface, first ones of the source and both maps. Where there are none, see
/// project(); where the ray is tangent to the source or the source's map is singular it is 0.
///
/// Throws as project(), and for a max_distance that is NaN or below 0. Cost: an evaluation, and one
/// ray each way.
Projection projectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                               Span<Location> at, const LimitSurface& source,
                               const SurfaceData& source_map, const SurfaceSearch& source_search,
                               const Eigen::Vector2d& texel,
                               const NormalProjectOptions& options = {}, int threads = 0);

/// What projectAlongNormals() throws for these arguments.
void checkProjectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                              const LimitSurface& source, const SurfaceData& source_map,
                              const Eigen::Vector2d& texel, const NormalProjectOptions& options);

/// Whether a perspective projector's eye is inside the surface: of 26 rays from it, to the corners,
/// edges and faces of a cube, more than half first meet a back where the surface is closed (every
/// edge has two faces, and none is refused), all of them where it is open. False for parallel
/// projection. Throws std::invalid_argument for a matrix that is not finite or singular.
bool eyeIsInside(const LimitSurface& surface, const SurfaceSearch& search,
                 const Eigen::Matrix4d& matrix, int threads = 0);

}  // namespace limitsurf
