// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"

namespace limitsurf {

/// The weights of a regular tile's points at (u, v), along each axis.
struct TileWeights {
  TileWeights(const BSplineTile& tile, double u, double v);
  CubicWeights u, v;
};

/// The rectangles of a regular tile on each of which it is one bicubic patch: the whole tile, or
/// strips along a crease.
struct TileStrips {
  explicit TileStrips(const BSplineTile& tile);

  struct Strip {
    double u0, u1, v0, v1;
  };
  Strip at(int i) const;

  int count;

 private:
  int side_;
  double borders_[4];  // distances from the crease
};

/// After enough subdivisions (u, v) on a ring tile lies outside of the vertex's own quarter: the
/// smallest number of steps for which it does, and the quarter in which it lies then (n and k in
/// Lacewell & Burley 2007, section 3.2, after Stam 1998). Must not be made for the vertex itself.
struct Quarter {
  Quarter(double u_, double v_) {
    const double larger = std::max(u_, v_);
    if (larger >= kEasyExponent) {
      steps = stepsTo(larger);
      const double scale = powerOfTwo(steps);
      u = u_ * scale;
      v = v_ * scale;
    } else {
      int exponent;
      std::frexp(larger, &exponent);  // larger in [2^(exponent - 1), 2^exponent)
      steps = 1 - exponent;
      u = std::ldexp(u_, steps);
      v = std::ldexp(v_, steps);
    }
    a = u >= 1 ? 1 : 0;
    b = v >= 1 ? 1 : 0;
    u -= a;
    v -= b;
  }

  /// The steps for the larger one of (u, v). Where that is 0, of either sign, or below 2^-1000 the
  /// result is only known to be 1000 or more.
  static int stepsTo(double larger) {
    std::uint64_t bits;
    std::memcpy(&bits, &larger, sizeof bits);
    const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
    return std::max(1, 1023 - exponent);  // larger in [2^-steps, 2^(1 - steps))
  }

  int steps;    ///< >= 1
  int a, b;     ///< 0 or 1, not both 0
  double u, v;  ///< where in the quarter, in [0, 1]

 private:
  /// From here on numbers are normal and 2^steps is finite, so that bits tell the exponent.
  static constexpr double kEasyExponent = 0x1p-1000;
};

/// The window on a ring tile's grid that determines the surface in the quarter, for derivatives up
/// to `order`.
inline GridWindow gridWindow(const Quarter& quarter, Sides sides, int order) {
  return {quarter.a, quarter.b, CubicWeights(quarter.u, onRight(sides) && quarter.a == 0, false),
          CubicWeights(quarter.v, onLeft(sides) && quarter.b == 0, false), order};
}

}  // namespace limitsurf
