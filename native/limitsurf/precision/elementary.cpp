// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/precision/elementary.h"

#include <cmath>

namespace limitsurf {
namespace {

/// sin(pi k / 16).
constexpr DoubleDouble kSines[9] = {
    0,
    DoubleDouble::ofParts(0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57),
    DoubleDouble::ofParts(0x1.87de2a6aea963p-2, -0x1.72cedd3d5a61p-57),
    DoubleDouble::ofParts(0x1.1c73b39ae68c8p-1, 0x1.b25dd267f66p-55),
    DoubleDouble::ofParts(0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55),
    DoubleDouble::ofParts(0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60),
    DoubleDouble::ofParts(0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56),
    DoubleDouble::ofParts(0x1.f6297cff75cbp-1, 0x1.562172a361fd3p-56),
    1};

constexpr DoubleDouble inverseFactorial(int n) {
  DoubleDouble result = 1;
  for (int i = 2; i <= n; ++i) {
    result /= i;
  }
  return result;
}

/// Beyond these terms of the series, doubles do: (pi/32)^10 / 11! and (pi/32)^12 / 12! are 2e-18
/// and 2e-21. Beyond those after kLastTerm nothing is left: (pi/32)^20 / 21! is 2e-40.
constexpr int kLastWideTerm = 10, kLastTerm = 20;

/// 1 / n!
struct InverseFactorials {
  DoubleDouble of[kLastTerm + 1];

  constexpr InverseFactorials() : of{} {
    for (int n = 0; n <= kLastTerm; ++n) {
      of[n] = inverseFactorial(n);
    }
  }
};
constexpr InverseFactorials kInverseFactorial;

/// The sum of square^i / (2 i + parity)!, |square| <= (pi/32)^2. With square = -r^2 it is cos(r) or
/// sin(r) / r, with r^2 it is cosh(r) or sinh(r) / r.
DoubleDouble taylorSum(const DoubleDouble& square, int parity) {
  double tail = 0;
  int n = kLastTerm - parity;
  for (; n > kLastWideTerm; n -= 2) {
    tail = tail * square.high() + kInverseFactorial.of[n].high();
  }
  DoubleDouble sum = kInverseFactorial.of[n] + square.times(tail);
  for (n -= 2; n >= 0; n -= 2) {
    sum = kInverseFactorial.of[n] + square * sum;
  }
  return sum;
}

}  // namespace

SineCosine<DoubleDouble> sineCosine(const DoubleDouble& x) {
  constexpr DoubleDouble kSixteenth =
      DoubleDouble::ofParts(kPi<DoubleDouble>.high() / 16, kPi<DoubleDouble>.low() / 16);
  const double multiple = std::round(x.high() / kSixteenth.high());
  const DoubleDouble rest = multiple == 0 ? x : x - kSixteenth.times(multiple);
  const DoubleDouble square = -(rest * rest);
  const DoubleDouble sine = rest * taylorSum(square, 1), cosine = taylorSum(square, 0);

  const int turn = static_cast<int>(multiple) & 31, quarter = turn / 8, part = turn % 8;
  SineCosine<DoubleDouble> result{sine, cosine};
  if (part != 0) {
    const DoubleDouble &s = kSines[part], &c = kSines[8 - part];
    result = {s * cosine + c * sine, c * cosine - s * sine};
  }
  switch (quarter) {
    case 1:
      return {result.cos, -result.sin};
    case 2:
      return {-result.sin, -result.cos};
    case 3:
      return {-result.cos, result.sin};
    default:
      return result;
  }
}

HyperbolicSineCosine hyperbolicSineCosine(const DoubleDouble& x) {
  int halvings = 0;
  double scale = 1;
  for (double size = std::abs(x.high()); size > 0.098; size /= 2) {
    ++halvings;
    scale /= 2;
  }
  const DoubleDouble rest = DoubleDouble::ofParts(x.high() * scale, x.low() * scale);
  const DoubleDouble first_square = rest * rest;
  HyperbolicSineCosine result{rest * taylorSum(first_square, 1), taylorSum(first_square, 0)};
  for (int i = 0; i < halvings; ++i) {
    const DoubleDouble product = result.sinh * result.cosh, square = result.sinh * result.sinh;
    result = {product + product, (square + square).plus(1)};
  }
  return result;
}

}  // namespace limitsurf
