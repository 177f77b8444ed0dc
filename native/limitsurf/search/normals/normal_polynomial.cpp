// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/normal_polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/search/patch_sides.h"

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
/// and t1. Parts of long and narrow patches go from 0 to 1 along one of the parameters.
void cut(Point* p, int stride, double t0, double t1) {
  constexpr int kDegree = 5;
  for (int level = 1; t1 < 1 && level <= kDegree; ++level) {
    for (int i = kDegree; i >= level; --i) {
      p[stride * i] = p[stride * (i - 1)] + t1 * (p[stride * i] - p[stride * (i - 1)]);
    }
  }
  const double rest = t0 / t1;
  for (int level = 1; t0 > 0 && level <= kDegree; ++level) {
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

void NormalPolynomial::cutTo(const ParameterRectangle& on, Point out[kCount]) const {
  std::copy(at_, at_ + kCount, out);
  for (int i = 0; i < kSize; ++i) {
    cut(out + kSize * i, 1, on.s, on.s + on.s_size);
  }
  for (int i = 0; i < kSize; ++i) {
    cut(out + i, kSize, on.t, on.t + on.t_size);
  }
}

NormalPolynomial::Cone NormalPolynomial::cone(const ParameterRectangle& on) const {
  Point part[kCount];
  cutTo(on, part);
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

bool NormalPolynomial::hasNoFoot(const ParameterRectangle& on, const Point points[16],
                                 double noise) const {
  Point normals[kCount];
  cutTo(on, normals);
  Point up = Point::Zero();
  for (const Point& normal : normals) {
    up += normal;
  }
  up /= norm(up);
  double rises[kCount];
  for (int i = 0; i < kCount; ++i) {
    rises[i] = dot(normals[i], up) - error_;
    if (!(rises[i] > error_)) {
      return false;
    }
  }
  double along = 0, largest = 0;
  for (int i = 0; i < 16; ++i) {
    along = std::max(along, std::abs(dot(points[i], up)));
    largest = std::max(largest, norm(points[i]));
  }
  // The part is a thin parallelogram if its tangents are nearly parallel. Feet are looked for
  // across its sides and along the longer one: the normals may lean far along it, and hardly
  // across.
  const Point one = sidesAlongS(points), other = sidesAlongT(points);
  const Point across = cross(up, one), across_other = cross(up, other);
  const Point& across_longer = dot(one, one) > dot(other, other) ? across : across_other;
  for (const Point& way : {across, across_other, cross(across_longer, up)}) {
    const double length = norm(way);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int i = 0; i < 16; ++i) {
      const double x = dot(points[i], way);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    const double least = std::max(low, -high);
    if (!(least > 0 && length > 0)) {
      continue;
    }
    // At a foot the difference from the searching point is at most so many times as far along the
    // way as it is along `up`: values of a quotient of polynomials are means of the quotients of
    // their coefficients if all denominators are positive.
    double leaning = 0;
    for (int i = 0; i < kCount; ++i) {
      leaning = std::max(leaning, (std::abs(dot(normals[i], way)) + error_ * length) / rises[i]);
    }
    const double error = noise + kRounding * largest;
    if (least > leaning * (along + error) + error * length) {
      return true;
    }
  }
  return false;
}

}  // namespace limitsurf
