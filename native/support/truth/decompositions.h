// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace limitsurf::test {

// Eigen's singular value decompositions, compiled once: each file that includes them would take ten
// seconds longer.

/// The rotation by the smallest angle from one direction to another.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Singular values, the largest first.
Eigen::Vector2d singularValues(const Eigen::Matrix<double, 3, 2>& matrix);
Eigen::Vector3d singularValues(const Eigen::Matrix3d& matrix);

}  // namespace limitsurf::test
