// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/differential.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "limitsurf/surface/scaled_tangents.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double squareRoot(double a) { return std::sqrt(a); }

#include "limitsurf/surface/batch/unit_normal.inl.h"

/// The order of additions is written down, because FrameKernels has the same one.
double dotProduct(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// v over its length; zero where the length is 0 or not finite.
Vector3 direction(const Vector3& v) {
  const double square = dotProduct(v, v);
  if (square >= 0x1p-900 && square <= 0x1p900) {  // nothing has been lost
    return v / std::sqrt(square);
  }
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) {
    return Vector3::Zero();
  }
  return (v / largest).normalized();
}

UnitNormal<double> scaledNormal(const Vector3& du, const Vector3& dv) {
  const ScaledTangents t(du, dv);
  return UnitNormal<double>(t.du.data(), t.dv.data());
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
  const UnitNormal<double> normal(du.data(), dv.data());
  if (normalKeepsDigits(normal.square, normal.lengths, normal.squares, 0, 0)) {
    return {normal.unit[0], normal.unit[1], normal.unit[2]};
  }
  const UnitNormal<double> scaled = scaledNormal(du, dv);
  return normalKeepsDigits(scaled.square, scaled.lengths, scaled.squares, 0, 0)
             ? Vector3(scaled.unit[0], scaled.unit[1], scaled.unit[2])
             : unitDirection(direction(du).cross(direction(dv)));
}

bool meetsLimits(const Vector3& du, const Vector3& dv, const NormalLimits& limits) {
  const UnitNormal<double> normal(du.data(), dv.data());
  return normalKeepsDigits(normal.square, normal.lengths, normal.squares, limits.sine_square,
                           limits.square);
}

bool areApart(const Vector3& du, const Vector3& dv, double lowest_sine_square) {
  const UnitNormal<double> scaled = scaledNormal(du, dv);
  return normalKeepsDigits(scaled.square, scaled.lengths, scaled.squares, lowest_sine_square, 0);
}

bool isWellConditioned(const Vector3& du, const Vector3& dv, double size) {
  const double largest = std::max(du.cwiseAbs().maxCoeff(), dv.cwiseAbs().maxCoeff());
  if (!(largest > 0) || !std::isfinite(largest)) {
    return false;
  }
  const Vector3 a = du / largest, b = dv / largest;
  const double lengths = a.squaredNorm() + b.squaredNorm();
  return std::sqrt(2 * lengths) * (size / largest) <= kMostNormalCondition * a.cross(b).norm();
}

Eigen::Matrix3d frame(const Vector3& du, const Vector3& dv, const Vector3& normal) {
  Vector3 tangent = direction(du), n = direction(normal);
  if (n.isZero(0)) {
    const Vector3 across = direction(dv);
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
    const Vector3 across = direction(dv);
    tangent = across.isZero(0) ? leastAlignedAxis(n) : Vector3(across.cross(n));
  }
  tangent = direction(tangent - dotProduct(tangent, n) * n);
  Eigen::Matrix3d result;
  result.col(0) = tangent;
  result.col(1) = n.cross(tangent);
  result.col(2) = n;
  return result;
}

double FundamentalForms::sine() const {
  const double lengths = du.norm() * dv.norm();
  return lengths > 0 ? cross.norm() / lengths : 0;
}

FundamentalForms fundamentalForms(const Jet& jet) {
  const auto largestOf = [](const auto&... derivatives) {
    const double largest = std::max({derivatives.abs().maxCoeff()...});
    return largest > 0 ? largest : 1;
  };
  const double first = largestOf(jet.patch.du, jet.patch.dv);
  const double second = largestOf(jet.patch.duu, jet.patch.duv, jet.patch.dvv);
  FundamentalForms forms;
  forms.du = jet.patch.du.head<3>() / first;
  forms.dv = jet.patch.dv.head<3>() / first;
  forms.cross = forms.du.cross(forms.dv);
  const Vector3 n = unitNormal(forms.du, forms.dv);
  const auto bend = [&](const Padded& derivative) {
    return (derivative / second).matrix().head<3>().dot(n);
  };
  forms.uu = bend(jet.patch.duu);
  forms.uv = bend(jet.patch.duv);
  forms.vv = bend(jet.patch.dvv);
  forms.scale = std::ldexp(second / first / first, jet.exponent);
  return forms;
}

PrincipalCurvatures principalCurvatures(const FundamentalForms& forms) {
  const Vector3 n = unitDirection(forms.cross);
  if (!n.allFinite()) {
    return {kNaN, kNaN, Vector3::Constant(kNaN), Vector3::Constant(kNaN)};
  }
  // In the orthonormal basis (x, y) of the tangent plane du = (a, 0), dv = (b, c).
  const Vector3 x = forms.du.normalized(), y = n.cross(x);
  const double a = forms.du.norm(), b = forms.dv.dot(x), c = forms.cross.norm() / a;
  const double xx = forms.uu / (a * a);
  const double xy = (forms.uv - b * a * xx) / (a * c);
  const double yy = (forms.vv - 2 * b * c * xy - b * b * xx) / (c * c);
  PrincipalCurvatures result = principalCurvatures({xx, xy, yy}, x, y);
  result.k1 *= forms.scale;
  result.k2 *= forms.scale;
  return result;
}

PrincipalCurvatures principalCurvatures(const ShapeOperator& shape, const Vector3& x,
                                        const Vector3& y) {
  const double mean = shape.xx / 2 + shape.yy / 2, half = shape.xx / 2 - shape.yy / 2,
               radius = std::hypot(half, shape.xy);
  // The first direction is at half of the angle of (half, xy). Where that is obtuse its sine is
  // taken first, so that neither is the difference of almost equal numbers.
  double cosine = 1, sine = 0;
  if (radius != 0) {
    const double larger = std::sqrt(0.5 + std::abs(half) / radius / 2),
                 smaller = std::abs(shape.xy) / radius / (2 * larger);
    cosine = half < 0 ? smaller : larger;
    sine = std::copysign(half < 0 ? larger : smaller, shape.xy);
  }
  return {mean + radius, mean - radius, cosine * x + sine * y, -sine * x + cosine * y};
}

}  // namespace limitsurf
