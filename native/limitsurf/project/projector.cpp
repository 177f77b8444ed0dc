// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/project/projector.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "limitsurf/direction_maps.h"
#include "limitsurf/number_text.h"

namespace limitsurf {
namespace {

/// Unit vectors that span at most this volume are linearly dependent.
constexpr double kSingular = 1e-13;
/// An eye farther away than this counts as infinitely far away. In diagonals of the surface.
constexpr double kFarthestEye = 1e10;

[[noreturn]] void refuseSingular(const char* name) {
  throw std::invalid_argument(std::string(name) + " is singular");
}

/// The vector perpendicular to three unit vectors; its length is the volume that they span.
Eigen::Vector4d perpendicular(const Eigen::RowVector4d& a, const Eigen::RowVector4d& b,
                              const Eigen::RowVector4d& c) {
  Eigen::Vector4d result;
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix3d minor;
    for (int j = 0, column = 0; j < 4; ++j) {
      if (j != i) {
        minor.col(column++) << a[j], b[j], c[j];
      }
    }
    result[i] = (i % 2 == 0 ? 1 : -1) * minor.determinant();
  }
  return result;
}

/// The part of a unit vector that is perpendicular to another one, as a unit vector; 0 if the two
/// are parallel.
Eigen::RowVector4d unitWithout(const Eigen::RowVector4d& removed, const Eigen::RowVector4d& from) {
  const Eigen::RowVector4d rest = from - from.dot(removed) * removed;
  return rest.norm() > kSingular ? rest.normalized().eval() : Eigen::RowVector4d::Zero().eval();
}

}  // namespace

void checkFinite(const Eigen::Matrix4d& matrix, const char* name) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!std::isfinite(matrix(row, column))) {
        throw std::invalid_argument(std::string(name) + " has " + numberText(matrix(row, column)) +
                                    " in row " + std::to_string(row) + ", column " +
                                    std::to_string(column));
      }
    }
  }
}

Eigen::Matrix3d invertibleLinearPart(const Eigen::Matrix4d& matrix, const char* name) {
  checkFinite(matrix, name);
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw std::invalid_argument(std::string(name) + " is not affine: its last row is not 0 0 0 1");
  }
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d in_units = withColumnsTimes(linear, -columnExponents(linear));
  if (!(std::abs(in_units.colwise().normalized().eval().determinant()) > kSingular)) {
    refuseSingular(name);
  }
  return linear;
}

Projector::Projector(const Eigen::Matrix4d& matrix, const LimitSurface& surface)
    : matrix_(scaleToOwnUnit(matrix.row(3).cwiseAbs().maxCoeff()) * matrix),
      eye_(Vector3::Zero()),
      backwards_(Vector3::Zero()) {
  checkFinite(matrix, "matrix");
  // All is computed in coordinates in which the surface has size 1 and lies around the origin.
  const Points& cage = surface.positions();
  Vector3 middle = Vector3::Zero();
  double size = 1;
  if (cage.rows() > 0) {
    const Eigen::RowVector3d low = cage.colwise().minCoeff(), high = cage.colwise().maxCoeff();
    middle = (low + high).transpose() / 2;
    size = (high - low).norm() > 0 ? (high - low).norm() : 1;
  }
  Eigen::Matrix4d from_unit = Eigen::Matrix4d::Identity();
  from_unit.topLeftCorner<3, 3>() *= size;
  from_unit.topRightCorner<3, 1>() = middle;
  Eigen::Matrix4d rows = matrix;
  for (int i = 0; i < 4; ++i) {
    rows.row(i) *= scaleToOwnUnit(matrix.row(i).cwiseAbs().maxCoeff());
  }
  rows = (rows * from_unit).eval();
  for (int i = 0; i < 4; ++i) {
    rows.row(i) = rows.row(i).stableNormalized().eval();
  }
  Eigen::Vector4d eye = perpendicular(rows.row(0), rows.row(1), rows.row(3));
  if (!(eye.norm() > kSingular)) {
    // So it is, too, where the surface lies far beside all that the matrix shows.
    const Eigen::RowVector4d depth = rows.row(3);
    eye = perpendicular(unitWithout(depth, rows.row(0)), unitWithout(depth, rows.row(1)), depth);
  }
  if (!(eye.norm() > kSingular)) {
    refuseSingular("matrix");
  }
  has_eye_ = std::abs(eye[3]) * kFarthestEye > eye.head<3>().norm();
  if (has_eye_) {
    eye_ = middle + size * (eye.head<3>() / eye[3]);
    return;
  }
  backwards_ = eye.head<3>().normalized();
  const double depth = rows.row(2).head<3>().dot(backwards_);
  if (!(std::abs(depth) > kSingular)) {
    refuseSingular("matrix");
  }
  if (depth > 0) {
    backwards_ = -backwards_;
  }
}

Projector::View Projector::see(const Vector3& point) const {
  const Eigen::Vector4d clip = matrix_ * point.homogeneous();
  View view;
  view.to_eye = has_eye_ ? (eye_ - point).stableNormalized() : backwards_;
  const double w = clip[3];
  view.st = (clip.head<2>() / w + Eigen::Vector2d::Ones()) / 2;
  view.depth = clip[2] / w;
  view.in_front =
      w > 0 && view.st.allFinite() && std::isfinite(view.depth) && view.to_eye.squaredNorm() > 0;
  for (int i = 0; i < 2; ++i) {
    view.st_by_point.row(i) =
        (matrix_.row(i).head<3>() - (clip[i] / w) * matrix_.row(3).head<3>()) / (2 * w);
  }
  return view;
}

double Projector::distanceToEye(const Vector3& point) const {
  return has_eye_ ? (eye_ - point).stableNorm() : std::numeric_limits<double>::infinity();
}

double Projector::distanceToPlane(const Vector3& point, const Vector3& to_eye, double near) const {
  const Eigen::RowVector4d plane = matrix_.row(2) - near * matrix_.row(3);
  const double height = plane * point.homogeneous(), slope = plane.head<3>() * to_eye;
  return slope < 0 ? height / -slope : std::numeric_limits<double>::infinity();
}

}  // namespace limitsurf
