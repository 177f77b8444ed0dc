// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "limitsurf/displace/subdivided_faces.h"
#include "limitsurf/project/ray_direction.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// An orthonormal 3x3 matrix in each row, row-major, of either handedness: its columns are tangent,
/// bitangent and normal.
using FrameRows = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

/// Bound on the error of each displacement, relative to the diagonal of the box around both control
/// meshes: the errors of two positions and of their difference.
constexpr double kDisplacementError = 3e-13;

/// The displacement from a surface to another one of the same structure: target(at) - base(at), a
/// row for each location on the base, for any two shapes. Both surfaces are evaluated exactly at
/// the same place, which `faces` finds; it must have been made for these two control meshes.
///
/// Error: kDisplacementError. Throws as LimitSurface::evaluate() on either surface; where a face of
/// the target has no limit surface, the MeshError names the target's face. Cost: two evaluations a
/// location.
Points vectorDisplacement(const LimitSurface& base, const LimitSurface& target,
                          const SubdividedFaces& faces, const LocationBatch& at, int threads = 0);

/// Each vector's components along the tangent, the normal and the bitangent of the frame in the
/// same row. Blender's Vector Displacement node reads them from red, green and blue in this order.
/// Throws std::invalid_argument if the numbers of rows differ.
Points intoFrames(const Points& vectors, const FrameRows& frames);

/// The vectors that have these components: the inverse of intoFrames() for orthonormal frames.
/// Throws as that does.
Points outOfFrames(const Points& components, const FrameRows& frames);

struct ScalarDisplacementOptions {
  double max_distance = std::numeric_limits<double>::infinity();
  RayDirection direction = RayDirection::both;
};

/// Moves the base's points by vectors. It is the inverse of vectorDisplacement(). `components` has
/// a row for each location. `frames` has as many rows, and the vectors are given by their
/// components in them; or it has none, and the vectors are given in space.
Points displaced(const LimitSurface& base, const LocationBatch& at, const Points& components,
                 const FrameRows& frames, int threads = 0);

/// The distance of another surface, of any structure, along the base's exact normal: the line
/// through base(at) along the normal meets the target in a nearest point, and the result is the
/// distance to it, negative if it lies inward, or NaN if there is none within max_distance. Of two
/// points that are equally near the outward one is taken. At irregular vertices without a normal
/// that of LimitSurface::frames() is used.
///
/// Error of the distance: kSearchError of the target's diagonal divided by the sine of the angle
/// between normal and target, plus the error of the base's position. Throws as
/// LimitSurface::evaluate(), and std::invalid_argument for a max_distance that is NaN or negative.
Eigen::VectorXd scalarDisplacement(const LimitSurface& base, const SurfaceSearch& target,
                                   const LocationBatch& at,
                                   const ScalarDisplacementOptions& options = {}, int threads = 0);

/// Moves each of the base's points along its normal by its distance. It is the inverse of
/// scalarDisplacement().
Points displacedAlongNormals(const LimitSurface& base, const LocationBatch& at,
                             const Eigen::VectorXd& distances, int threads = 0);

}  // namespace limitsurf
