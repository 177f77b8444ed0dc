// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/root_pose.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/vertex_approach.h"

namespace limitsurf {
namespace {

/// If the sine of the angle between du and dv is larger, their cross product keeps all digits that
/// kNormalError needs.
constexpr double kSafeSine = 0x1p-7;
/// Squares of lengths between these bounds neither overflow nor lose digits.
constexpr double kSmallSquare = 1e-140, kLargeSquare = 1e140;

Padded cross(const Padded& a, const Padded& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

double squaredLength(const Padded& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

Vector3 vector(const Padded& v) { return {v[0], v[1], v[2]}; }

}  // namespace

RootMap::RootMap(const Eigen::Matrix4d& map) : directions_(map.topLeftCorner<3, 3>()) {
  for (int column = 0; column < 4; ++column) {
    map_[column] = Padded(map(0, column), map(1, column), map(2, column), 0);
  }
}

bool RootMap::carry(const Padded& position, const Padded& du_on_surface,
                    const Padded& dv_on_surface, const NormalLimits& limits, RootPose& root) const {
  root.position = map_[3] + carried(position);
  const Padded du = carried(du_on_surface), dv = carried(dv_on_surface), normal = cross(du, dv);
  const double du_square = squaredLength(du), dv_square = squaredLength(dv),
               normal_square = squaredLength(normal);
  // Comparisons with NaN are false.
  if (!(meetsLimits(du_on_surface.head<3>(), dv_on_surface.head<3>(), limits) &&
        du_square > kSmallSquare && du_square < kLargeSquare && dv_square < kLargeSquare &&
        normal_square > kSafeSine * kSafeSine * du_square * dv_square &&
        normal_square > kSmallSquare)) {
    return false;
  }
  root.frame[0] = (1 / std::sqrt(du_square)) * du;
  root.frame[2] = (directions_.side / std::sqrt(normal_square)) * normal;
  root.frame[1] = cross(root.frame[2], root.frame[0]);
  return true;
}

void RootMap::carryFrame(const Eigen::Matrix3d& on_surface, Padded out[3]) const {
  const Vector3 tangent = directions_.vectors * on_surface.col(0),
                across = directions_.vectors * on_surface.col(1);
  const double side = directions_.side;
  const Vector3 normal = side * unitNormal(tangent, across);
  const Eigen::Matrix3d result =
      frame(tangent, side * across, normal.allFinite() ? normal : Vector3(Vector3::Zero()));
  for (int column = 0; column < 3; ++column) {
    out[column] = Padded(result(0, column), result(1, column), result(2, column), 0);
  }
}

RootPose RootFinder::operator()(const TileLocation& at) {
  Jet jet;
  evaluator_.evaluate<1>(at, jet);
  RootPose root;
  const bool is_carried = map_.carry(jet.anchor + jet.patch.value, jet.patch.du, jet.patch.dv,
                                     evaluator_.normalLimits(at), root);
  if (at.atVertex()) {
    const VertexApproach towards =
        vertexApproach(table_, pose_, static_cast<int>(at.tile.index), at.turns);
    map_.carryFrame(frame(towards.du, towards.dv, towards.normal), root.frame);
  } else if (!is_carried) {
    const Vector3 normal = evaluator_.normalDirection(at, jet);
    map_.carryFrame(frame(vector(jet.patch.du), vector(jet.patch.dv),
                          normal.allFinite() ? normal : Vector3(Vector3::Zero())),
                    root.frame);
  }
  return root;
}

}  // namespace limitsurf
