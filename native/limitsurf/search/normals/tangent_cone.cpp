// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/tangent_cone.h"

#include <cmath>

namespace limitsurf {
namespace {

/// The rounding of a tangent of a patch, relative to its length: more than that of the three
/// differences and interpolations that it is made of.
constexpr double kTangentRounding = 1e-14;

}  // namespace

TangentCone::TangentCone(const Vector3& ds, double s_inwards, const Vector3& dt, double t_inwards) {
  if (s_inwards != 0 && t_inwards != 0) {
    first_ = along(ds, s_inwards);
    second_ = along(dt, t_inwards);
  } else if (s_inwards != 0) {
    // A sheet that ends along dt goes on in all directions on one side of dt.
    first_ = along(dt, 0);
    second_ = across(ds, s_inwards, first_);
  } else {
    first_ = along(ds, 0);
    second_ = across(dt, t_inwards, first_);
  }
}

bool TangentCone::falls(const Vector3& offset, double tolerance) const {
  const double distance = offset.norm();
  for (const Direction& direction : {first_, second_}) {
    const double slope = offset.dot(direction.unit);
    const double fall = direction.inwards == 0 ? std::abs(slope) : -direction.inwards * slope;
    if (fall > (kFlatSlope + direction.rounding) * distance + tolerance) {
      return true;
    }
  }
  return false;
}

TangentCone::Direction TangentCone::along(const Vector3& tangent, double inwards) {
  const double length = tangent.norm();
  return length > 0 ? Direction{tangent / length, inwards, kTangentRounding} : Direction{};
}

TangentCone::Direction TangentCone::across(const Vector3& tangent, double inwards,
                                           const Direction& other) {
  const Vector3 part = tangent - tangent.dot(other.unit) * other.unit;
  Direction direction = along(part, inwards);
  if (direction.rounding > 0) {
    direction.rounding *= tangent.norm() / part.norm();
  }
  return direction;
}

}  // namespace limitsurf
