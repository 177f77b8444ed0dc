// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "limitsurf/types.h"

namespace limitsurf {

/// One number for each side of a box, +x, -x, +y, -y, +z, -z.
using BoxWeights = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// Six planar projectors (projector.h), one for each side of a box. `matrix` takes the surface's
/// coordinates to the box's, in which it reaches from -1 to 1. Seen from outside the image is not
/// mirrored on any side; z is up on four, y is on the sides +z and -z.
///
/// Throws std::invalid_argument for a matrix that is not finite, not affine or singular.
std::array<Eigen::Matrix4d, 6> boxSides(const Eigen::Matrix4d& matrix);

/// How much each side counts for a surface with these normals. A normal gives three sides weight,
/// in proportion to by how much its component is above (1 - blend) of the largest; with blend 0 the
/// first of the largest takes all. Rows add up to 1.
///
/// Throws std::invalid_argument as boxSides(), for a blend outside [0, 1], and naming the first
/// normal that is 0 or not finite.
BoxWeights boxWeights(const Points& normals, double blend, const Eigen::Matrix4d& matrix);

}  // namespace limitsurf
