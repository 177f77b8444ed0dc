// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/flow/tangent_planes.h"

#include <Eigen/Geometry>
#include <cmath>

namespace limitsurf {

PlaneBasis planeBasis(const Vector3& normal) {
  const double sign = std::copysign(1., normal.z());
  const double a = -1 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  PlaneBasis basis;
  basis.col(0) << 1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x();
  basis.col(1) << b, sign + normal.y() * normal.y() * a, -normal.y();
  return basis;
}

PlaneBasis turned(const PlaneBasis& basis, const Vector3& from, const Vector3& to) {
  const double cosine = from.dot(to);
  const Vector3 start = cosine < 0 ? Vector3(-from) : from;
  // the rotation takes `start` to `to`; what is perpendicular to both stays
  const Vector3 middle = start + to;
  const Vector3 scaled = middle / (1 + std::abs(cosine));
  PlaneBasis result;
  for (int i = 0; i < 2; ++i) {
    result.col(i) = basis.col(i) - scaled * to.dot(basis.col(i));
  }
  return result;
}

}  // namespace limitsurf
