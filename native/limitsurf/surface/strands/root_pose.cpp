// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/root_pose.h"

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/vertex_approach.h"

namespace limitsurf {
namespace {

Padded cross(const Padded& a, const Padded& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

double squaredLength(const Padded& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

Vector3 vector(const Padded& v) { return {v[0], v[1], v[2]}; }

}  // namespace

RootPose RootFinder::operator()(const TileLocation& at) {
  Jet jet;
  evaluator_.evaluate<1>(at, jet);
  RootPose root;
  root.position = map_[3] + carried(jet.anchor + jet.patch.value);
  const Padded du = carried(jet.patch.du), dv = carried(jet.patch.dv), normal = cross(du, dv);
  const double du_square = squaredLength(du), dv_square = squaredLength(dv),
               normal_square = squaredLength(normal);
  // Comparisons with NaN are false.
  if (!at.atVertex() && evaluator_.hasPlainNormal(at, jet) && du_square > kSmallSquare &&
      du_square < kLargeSquare && dv_square < kLargeSquare &&
      normal_square > kSafeSine * kSafeSine * du_square * dv_square &&
      normal_square > kSmallSquare) {
    root.frame[0] = (1 / std::sqrt(du_square)) * du;
    root.frame[2] = (directions_.side / std::sqrt(normal_square)) * normal;
    root.frame[1] = cross(root.frame[2], root.frame[0]);
  } else {
    setFrame(at, jet, root.frame);
  }
  return root;
}

void RootFinder::setFrame(const TileLocation& at, const Jet& jet, Padded out[3]) {
  Eigen::Matrix3d on_surface;
  if (at.atVertex()) {
    const VertexApproach towards =
        vertexApproach(table_, pose_, static_cast<int>(at.tile.index), at.turns);
    on_surface = frame(towards.du, towards.dv, towards.normal);
  } else {
    const Vector3 normal = evaluator_.normalDirection(at, jet);
    on_surface = frame(vector(jet.patch.du), vector(jet.patch.dv),
                       normal.allFinite() ? normal : Vector3(Vector3::Zero()));
  }
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

}  // namespace limitsurf
