// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/oriented_box.h"

#include <Eigen/Geometry>
#include <cmath>

namespace limitsurf {
namespace {

/// Directions at a smaller angle do not span a plane well enough: the coordinate axes serve
/// instead.
constexpr double kLeastSine = 1e-6;

template <typename Real>
Real roundedUpTo(double value) {
  return std::nextafter(static_cast<Real>(value), std::numeric_limits<Real>::infinity());
}

}  // namespace

template <typename Real>
void OrientedBox<Real>::place(const Vector3& centre, const Eigen::Matrix3d& frame) {
  for (int i = 0; i < 3; ++i) {
    centre_[i] = static_cast<Real>(centre[i]);
    for (int j = 0; j < 3; ++j) {
      axes_[i][j] = static_cast<Real>(frame(i, j));
    }
  }
}

template <typename Real>
OrientedBox<Real>::OrientedBox(Span<Padded> points, const Vector3& along, const Vector3& across) {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // an axis in each row
  const Vector3 normal = along.cross(across);
  if (normal.norm() > kLeastSine * along.norm() * across.norm() && along.allFinite() &&
      across.allFinite()) {
    frame.row(0) = along.normalized();
    frame.row(2) = normal.normalized();
    frame.row(1) = frame.row(2).cross(frame.row(0));
  }
  Padded axes[3];  // a coordinate of all three in each
  for (int i = 0; i < 3; ++i) {
    axes[i] << frame.col(i).array(), 0;
  }
  const auto turn = [&](const Padded& v) -> Padded {
    return v[0] * axes[0] + v[1] * axes[1] + v[2] * axes[2];
  };
  Padded low = turn(points[0]), high = low;
  for (const Padded& point : points) {
    const Padded turned = turn(point);
    low = low.min(turned);
    high = high.max(turned);
  }
  place(frame.transpose() * (0.5 * (low + high)).head<3>().matrix(), frame);
  // Extents are measured along the axes as they were rounded. (Four numbers at a time, GCC 12
  // leaves out the rounding.)
  for (int i = 0; i < 3; ++i) {
    double half = 0;
    for (const Padded& point : points) {
      half = std::max(half, std::abs(coordinate(i, point.head<3>())));
    }
    half_[i] = roundedUpTo<Real>(half);
  }
}

template <typename Real>
OrientedBox<Real>::OrientedBox(const CoreHull& hull, const Vector3& middle) {
  static_assert(std::numeric_limits<Real>::digits >= 53, "the axes are not rounded");
  const Vector3 centre = hull.axes.transpose() * (0.5 * (hull.low + hull.high));
  place((hull.vertex - middle) + centre, hull.axes);
  const Vector3 half = 0.5 * (hull.high - hull.low);
  for (int i = 0; i < 3; ++i) {
    half_[i] = roundedUpTo<Real>(half[i]);
  }
}

template OrientedBox<float>::OrientedBox(Span<Padded>, const Vector3&, const Vector3&);
template OrientedBox<double>::OrientedBox(Span<Padded>, const Vector3&, const Vector3&);
template OrientedBox<double>::OrientedBox(const CoreHull&, const Vector3&);

}  // namespace limitsurf
