// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/differential.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// v over its length; zero where the length is 0 or not finite.
Vector3 direction(const Vector3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) {
    return Vector3::Zero();
  }
  return (v / largest).normalized();
}

Vector3 leastAlignedAxis(const Vector3& unit) {
  int axis;
  unit.cwiseAbs().minCoeff(&axis);
  return Vector3::Unit(axis);
}

}  // namespace

Vector3 unitDirection(const Vector3& v) {
  const Vector3 unit = direction(v);
  return unit.isZero(0) ? Vector3(Vector3::Constant(kNaN)) : unit;
}

Vector3 unitNormal(const Vector3& du, const Vector3& dv) {
  return unitDirection(direction(du).cross(direction(dv)));
}

Eigen::Matrix3d frame(const Vector3& du, const Vector3& dv, const Vector3& normal) {
  Vector3 tangent = direction(du), n = direction(normal);
  const Vector3 across = direction(dv);
  if (n.isZero(0)) {
    if (!tangent.isZero(0)) {
      n = direction(tangent.cross(leastAlignedAxis(tangent)));
    } else if (!across.isZero(0)) {
      n = direction(leastAlignedAxis(across).cross(across));
      tangent = across.cross(n);
    } else {
      tangent = Vector3::UnitX();
      n = Vector3::UnitZ();
    }
  } else if (tangent.isZero(0)) {
    tangent = across.isZero(0) ? leastAlignedAxis(n) : Vector3(across.cross(n));
  }
  tangent = direction(tangent - tangent.dot(n) * n);
  Eigen::Matrix3d result;
  result.col(0) = tangent;
  result.col(1) = n.cross(tangent);
  result.col(2) = n;
  return result;
}

PrincipalCurvatures principalCurvatures(const Jet& jet) {
  const double first = std::max(jet.patch.du.abs().maxCoeff(), jet.patch.dv.abs().maxCoeff());
  const Vector3 du = jet.patch.du.head<3>() / first, dv = jet.patch.dv.head<3>() / first;
  const Vector3 n = unitNormal(du, dv);
  if (!n.allFinite()) {
    return {kNaN, kNaN, Vector3::Constant(kNaN), Vector3::Constant(kNaN)};
  }
  double second = std::max({jet.patch.duu.abs().maxCoeff(), jet.patch.duv.abs().maxCoeff(),
                            jet.patch.dvv.abs().maxCoeff()});
  if (second == 0) {
    second = 1;
  }
  // In the orthonormal basis (x, y) of the tangent plane du = (a, 0), dv = (b, c).
  const Vector3 x = du.normalized(), y = n.cross(x);
  const double a = du.norm(), b = dv.dot(x), c = dv.dot(y);
  const double uu = (jet.patch.duu / second).matrix().head<3>().dot(n);
  const double uv = (jet.patch.duv / second).matrix().head<3>().dot(n);
  const double vv = (jet.patch.dvv / second).matrix().head<3>().dot(n);
  const double xx = uu / (a * a);
  const double xy = (uv - b * a * xx) / (a * c);
  const double yy = (vv - 2 * b * c * xy - b * b * xx) / (c * c);

  const double scale = std::ldexp(second / first / first, jet.exponent);
  PrincipalCurvatures result = principalCurvatures({xx, xy, yy}, x, y);
  result.k1 *= scale;
  result.k2 *= scale;
  return result;
}

PrincipalCurvatures principalCurvatures(const ShapeOperator& shape, const Vector3& x,
                                        const Vector3& y) {
  const double mean = shape.xx / 2 + shape.yy / 2, half = shape.xx / 2 - shape.yy / 2,
               radius = std::hypot(half, shape.xy);
  const double angle = std::atan2(shape.xy, half) / 2;
  return {mean + radius, mean - radius, std::cos(angle) * x + std::sin(angle) * y,
          -std::sin(angle) * x + std::cos(angle) * y};
}

}  // namespace limitsurf
