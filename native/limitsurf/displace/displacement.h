// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "limitsurf/displace/subdivided_faces.h"
#include "limitsurf/project/ray_direction.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// One 3x3 matrix a row, row-major: columns tangent, bitangent, normal; orthonormal, of either
/// handedness.
using FrameRows = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

/// Bound on the error of each displacement, relative to the diagonal of both control meshes
/// together: two positions and their difference.
constexpr double kDisplacementError = 3e-13;

/// How to get from a surface to another one of the same structure: target(at) - base(at), one row
/// per location on the base, whatever the two shapes are. Both are evaluated exactly at the very
/// same place, found by `faces`, which must have been made for these two control meshes.
///
/// Error: kDisplacementError. Throws as LimitSurface::evaluate() on either surface; where a face of
/// the target has no limit surface, the MeshError names the target's face. Cost: two evaluations a
/// location.
Points vectorDisplacement(const LimitSurface& base, const LimitSurface& target,
                          const SubdividedFaces& faces, Span<Location> at, int threads = 0);

/// Vectors as their components along tangent, normal and bitangent of a frame each, and back: this
/// is the order in which Blender's Vector Displacement node reads red, green and blue. The two are
/// each other's inverse for orthonormal frames. Throw std::invalid_argument for numbers of rows
/// that differ.
Points intoFrames(const Points& vectors, const FrameRows& frames);
Points outOfFrames(const Points& components, const FrameRows& frames);

struct ScalarDisplacementOptions {
  double max_distance = std::numeric_limits<double>::infinity();
  RayDirection direction = RayDirection::both;
};

/// The base's points moved by vectors, given by their components where there are frames: reads a
/// displacement back. `components` and `frames` have a row for each location, or `frames` none.
Points displaced(const LimitSurface& base, Span<Location> at, const Points& components,
                 const FrameRows& frames, int threads = 0);

/// How far along the base's exact normal another surface lies, of any structure: the distance to
/// the nearest point at which the line through base(at) along the normal meets the target; negative
/// for inward, NaN where it meets nothing within max_distance. The outward one of two equally near
/// ones is taken. At irregular vertices without a normal that of LimitSurface::frames() is used.
///
/// Error of the distance: kSearchError of the target's diagonal, divided by the sine of the angle
/// between normal and target, besides that of the base's position. Throws as
/// LimitSurface::evaluate(), and std::invalid_argument for a max_distance that is NaN or negative.
Eigen::VectorXd scalarDisplacement(const LimitSurface& base, const SurfaceSearch& target,
                                   Span<Location> at, const ScalarDisplacementOptions& options = {},
                                   int threads = 0);

/// The base's points moved so far along its normals, the same ones.
Points displacedAlongNormals(const LimitSurface& base, Span<Location> at,
                             const Eigen::VectorXd& distances, int threads = 0);

}  // namespace limitsurf
