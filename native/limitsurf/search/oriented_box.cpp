// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/oriented_box.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/float_rounding.h"

namespace limitsurf {
namespace {

/// Directions at a smaller angle do not span a plane well enough: the coordinate axes serve
/// instead.
constexpr double kLeastSine = 1e-6;

}  // namespace

OrientedBox::OrientedBox(const Eigen::Ref<const Points>& points, const Vector3& along,
                         const Vector3& across) {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // an axis in each row
  const Vector3 normal = along.cross(across);
  if (normal.norm() > kLeastSine * along.norm() * across.norm() && along.allFinite() &&
      across.allFinite()) {
    frame.row(0) = along.normalized();
    frame.row(2) = normal.normalized();
    frame.row(1) = frame.row(2).cross(frame.row(0));
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 3> turned = points * frame.transpose();
  const Eigen::RowVector3d low = turned.colwise().minCoeff(), high = turned.colwise().maxCoeff();
  const Vector3 centre = frame.transpose() * (0.5 * (low + high)).transpose();
  for (int i = 0; i < 3; ++i) {
    centre_[i] = static_cast<float>(centre[i]);
    for (int j = 0; j < 3; ++j) {
      axes_[i][j] = static_cast<float>(frame(i, j));
    }
  }
  // Extents are measured along the axes as they were rounded.
  for (int i = 0; i < 3; ++i) {
    double half = 0;
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
      half = std::max(half, std::abs(coordinate(i, points.row(p).transpose())));
    }
    half_[i] = roundedUp(half);
  }
}

OrientedBox::OrientedBox(const Box& box) {
  const Vector3 centre = box.low + (box.high - box.low) / 2;
  for (int i = 0; i < 3; ++i) {
    centre_[i] = static_cast<float>(centre[i]);
    for (int j = 0; j < 3; ++j) {
      axes_[i][j] = i == j ? 1.f : 0.f;
    }
    half_[i] = roundedUp(std::max(box.high[i] - centre_[i], centre_[i] - box.low[i]));
  }
}

}  // namespace limitsurf
