// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/normal_polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limitsurf {
namespace {

using Point = BezierPatch::Point;

/// The relative rounding of a coefficient, and of sums of three products.
constexpr double kCoefficientRounding = 1e-14, kRounding = 1e-15;
/// Directions whose sum is shorter have no common axis.
constexpr double kLeastAxis = 0.01;

double norm(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

/// Replaces the Bernstein coefficients of a polynomial of degree 5 by those of its part between t0
/// and t1.
void cut(Point* p, int stride, double t0, double t1) {
  constexpr int kDegree = 5;
  for (int level = 1; level <= kDegree; ++level) {
    for (int i = kDegree; i >= level; --i) {
      p[stride * i] = p[stride * (i - 1)] + t1 * (p[stride * i] - p[stride * (i - 1)]);
    }
  }
  const double rest = t0 / t1;
  for (int level = 1; level <= kDegree; ++level) {
    for (int i = 0; i <= kDegree - level; ++i) {
      p[stride * i] += rest * (p[stride * (i + 1)] - p[stride * i]);
    }
  }
}

}  // namespace

NormalPolynomial::NormalPolynomial(const BezierPatch& patch, double noise) {
  constexpr double kOf2[3] = {1, 2, 1}, kOf3[4] = {1, 3, 3, 1};
  constexpr double kOf5[6] = {1, 5, 10, 10, 5, 1};
  Point ds[12], dt[12];  // [3 j + i] for the coefficient (i, j) of P_s / 3, [3 i + j] of P_t / 3
  double largest_s = 0, largest_t = 0;
  const Point* p = patch.points;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      ds[3 * j + i] = p[4 * j + i + 1] - p[4 * j + i];
      dt[3 * j + i] = p[4 * (i + 1) + j] - p[4 * i + j];
      largest_s = std::max(largest_s, norm(ds[3 * j + i]));
      largest_t = std::max(largest_t, norm(dt[3 * j + i]));
    }
  }
  for (Point& sum : at_) {
    sum.setZero();
  }
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 3; ++y) {
          at_[kSize * (j + y) + i + x] +=
              kOf2[i] * kOf3[x] * kOf3[j] * kOf2[y] * cross(ds[3 * j + i], dt[3 * x + y]);
        }
      }
    }
  }
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      at_[kSize * j + i] /= kOf5[i] * kOf5[j];
    }
  }
  // Coefficients are means of cross products.
  error_ = kCoefficientRounding * largest_s * largest_t + 2 * noise * (largest_s + largest_t);
}

NormalPolynomial::Cone NormalPolynomial::cone(const ParameterRectangle& on) const {
  Point part[kSize * kSize];
  std::copy(at_, at_ + kSize * kSize, part);
  for (int i = 0; i < kSize; ++i) {
    cut(part + kSize * i, 1, on.s, on.s + on.s_size);
  }
  for (int i = 0; i < kSize; ++i) {
    cut(part + i, kSize, on.t, on.t + on.t_size);
  }
  const double unknown = std::numeric_limits<double>::infinity();
  Cone cone{Point::Zero(), 0};
  for (const Point& normal : part) {
    const double length = norm(normal);
    if (!(length > error_)) {
      return {cone.axis, unknown};
    }
    cone.axis += normal / length;
  }
  const double length = norm(cone.axis);
  if (!(length > kLeastAxis)) {
    return {cone.axis, unknown};
  }
  cone.axis /= length;
  for (const Point& normal : part) {
    const double along = dot(normal, cone.axis);
    if (!(along > 2 * error_)) {
      return {cone.axis, unknown};
    }
    cone.tangent =
        std::max(cone.tangent, (norm(normal - along * cone.axis) + error_) / (along - error_));
  }
  return cone;
}

bool NormalPolynomial::isBesideFeet(const Point points[16], double noise) const {
  const Point one = (points[3] - points[0]) + (points[15] - points[12]),
              other = (points[12] - points[0]) + (points[15] - points[3]);
  const Point& side = dot(one, one) > dot(other, other) ? one : other;
  Point sum = at_[0];
  for (int i = 1; i < kSize * kSize; ++i) {
    sum += at_[i];
  }
  Point across = cross(sum, side);
  across /= norm(across);
  Point up = cross(side, across);
  up /= norm(up);
  double leaning = 0;
  for (const Point& normal : at_) {
    const double rise = dot(normal, up) - 2 * error_;
    if (!(rise > 0)) {
      return false;
    }
    leaning = std::max(leaning, (std::abs(dot(normal, across)) + 2 * error_) / rise);
  }
  double along = 0, largest = 0, low = std::numeric_limits<double>::infinity(), high = -low;
  for (int i = 0; i < 16; ++i) {
    const double x = dot(points[i], across);
    low = std::min(low, x);
    high = std::max(high, x);
    along = std::max(along, std::abs(dot(points[i], up)));
    largest = std::max(largest, norm(points[i]));
  }
  // At a foot the difference is a multiple of the normal.
  const double aside = leaning * (along + noise) + noise + kRounding * largest;
  return low > aside || high < -aside;
}

bool hasNoFoot(const Point points[16], const NormalPolynomial::Cone& normals, double noise) {
  if (!(normals.tangent < std::numeric_limits<double>::infinity())) {
    return false;
  }
  double along = 0, largest = 0;
  for (int i = 0; i < 16; ++i) {
    along = std::max(along, std::abs(dot(points[i], normals.axis)));
    largest = std::max(largest, norm(points[i]));
  }
  // At a foot the difference is within the cone or its opposite, and this far from the axis.
  const double aside = normals.tangent * (along + noise) + noise + kRounding * largest;
  // The patch is a thin parallelogram if its tangents are nearly parallel. It is separated from the
  // axis in directions perpendicular to its sides.
  for (const Point& side : {Point((points[3] - points[0]) + (points[15] - points[12])),
                            Point((points[12] - points[0]) + (points[15] - points[3]))}) {
    const Point across = cross(normals.axis, side);
    const double length = norm(across);
    if (!(length > 0)) {
      continue;
    }
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int i = 0; i < 16; ++i) {
      const double x = dot(points[i], across);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (low > aside * length || high < -aside * length) {
      return true;
    }
  }
  return false;
}

}  // namespace limitsurf
