// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "limitsurf/types.h"

namespace limitsurf {

/// A weight for each side of a box, in the order +x, -x, +y, -y, +z, -z.
using BoxWeights = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// The six parallel projectors of a box, one for each side, as matrices for project(). `matrix`
/// takes the surface's coordinates to those of the box, which reaches from -1 to 1. Seen from
/// outside, the image is not mirrored on any side; z is up on four sides, and y is up on the sides
/// +z and -z.
///
/// Throws std::invalid_argument for a matrix that is not finite, not affine or singular.
std::array<Eigen::Matrix4d, 6> boxSides(const Eigen::Matrix4d& matrix);

/// The weights of the six projectors for a surface with these normals. A normal gives weight to at
/// most three sides, in proportion to the amount by which its component exceeds (1 - blend) times
/// the largest one; with blend 0 the first of the largest components takes all. Each row adds up
/// to 1.
///
/// Throws std::invalid_argument as boxSides(), for a blend outside [0, 1], and naming the first
/// normal that is 0 or not finite.
BoxWeights boxWeights(const Points& normals, double blend, const Eigen::Matrix4d& matrix);

}  // namespace limitsurf
