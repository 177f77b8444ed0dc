// SPDX-License-Identifier: Apache-2.0
#include "support/truth/decompositions.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace limitsurf::test {

Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

Eigen::Vector2d singularValues(const Eigen::Matrix<double, 3, 2>& matrix) {
  return matrix.jacobiSvd().singularValues();
}

Eigen::Vector3d singularValues(const Eigen::Matrix3d& matrix) {
  return matrix.jacobiSvd().singularValues();
}

}  // namespace limitsurf::test
