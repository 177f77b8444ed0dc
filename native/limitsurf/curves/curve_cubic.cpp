// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/curve_cubic.h"

#include <algorithm>

#include "limitsurf/bernstein.h"

namespace limitsurf {
namespace {

/// The points and weights of Gauss-Legendre quadrature on [-1, 1], the positive half.
constexpr int kPairs = 5;
constexpr double kAt[kPairs] = {0.14887433898163122, 0.43339539412924719, 0.67940956829902441,
                                0.86506336668898451, 0.97390652851717172};
constexpr double kWeight[kPairs] = {0.29552422471475287, 0.26926671930999635, 0.21908636251598204,
                                    0.14945134915058059, 0.066671344308688138};

/// Speeds above this part of the largest make no kink that quadrature may overlook: within 2^-7 of
/// a cubic, where no point of the quadrature lies, the speed then changes by less than its tenth.
constexpr double kSlow = 0.1;
/// The rounding of `change` below, relative to the squares of the differences it comes from.
constexpr double kRounding = 0x1p-50;

/// A cubic polynomial on [0, 1] by its Bernstein coefficients.
struct Polynomial {
  double c[4];

  /// Splits it in the middle.
  void halve(Polynomial& low, Polynomial& high) const {
    double p[4] = {c[0], c[1], c[2], c[3]};
    Bernstein<3>::halve(
        p, [&](int i, double x) { low.c[i] = x; }, [&](int i, double x) { high.c[i] = x; });
  }
};

/// Appends the zeros of a polynomial on [from, to]: places where it changes its sign, or is not
/// larger than `rounding`.
void findZeros(const Polynomial& f, double from, double to, double rounding,
               std::vector<double>& out) {
  const double least = std::min({f.c[0], f.c[1], f.c[2], f.c[3]}),
               largest = std::max({f.c[0], f.c[1], f.c[2], f.c[3]});
  if (least > 0 || largest < 0) {
    return;
  }
  const double middle = 0.5 * (from + to);
  if (std::max(-least, largest) <= rounding || middle <= from || middle >= to) {
    out.push_back(middle);
    return;
  }
  Polynomial low, high;
  f.halve(low, high);
  findZeros(low, from, middle, rounding, out);
  findZeros(high, middle, to, rounding, out);
}

}  // namespace

std::vector<double> CurveCubic::turns() const {
  // The squared speed, but for a factor of 9, by its Bernstein coefficients
  const Point d[3] = {points[1] - points[0], points[2] - points[1], points[3] - points[2]};
  const double squared[5] = {dot(d[0], d[0]), dot(d[0], d[1]),
                             (dot(d[0], d[2]) + 2 * dot(d[1], d[1])) / 3, dot(d[1], d[2]),
                             dot(d[2], d[2])};
  const double largest = std::max({squared[0], dot(d[1], d[1]), squared[4]});
  const double slow = kSlow * kSlow * largest;
  std::vector<double> minima;
  if (*std::min_element(squared, squared + 5) > slow) {
    return minima;
  }
  // A quarter of its derivative
  const Point e[2] = {d[1] - d[0], d[2] - d[1]};
  const Polynomial change{{dot(d[0], e[0]), (dot(d[0], e[1]) + 2 * dot(d[1], e[0])) / 3,
                           (2 * dot(d[1], e[1]) + dot(d[2], e[0])) / 3, dot(d[2], e[1])}};
  findZeros(change, 0, 1, kRounding * largest, minima);
  const double slow_speed = 3 * std::sqrt(slow);
  minima.erase(
      std::remove_if(minima.begin(), minima.end(), [&](double t) { return speed(t) > slow_speed; }),
      minima.end());
  return minima;
}

double CurveCubic::quadrature(double from, double to) const {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int i = 0; i < kPairs; ++i) {
    sum += kWeight[i] * (speed(middle - half * kAt[i]) + speed(middle + half * kAt[i]));
  }
  return half * sum;
}

}  // namespace limitsurf
