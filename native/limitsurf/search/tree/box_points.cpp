// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/box_points.h"

#include <Eigen/Eigenvalues>

namespace limitsurf {

LeafBox BoxPoints::alongPrincipalAxes() const {
  Padded sum = Padded::Zero();
  for (const Padded& point : points_) {
    sum += point;
  }
  const Padded mean = sum / static_cast<double>(points_.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Padded& point : points_) {
    const Vector3 off = (point - mean).head<3>();
    spread += off * off.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  return oriented<float>(axes.col(2), axes.col(1));
}

}  // namespace limitsurf
