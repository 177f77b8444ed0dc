// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "limitsurf/eigen/bspline_window.h"
#include "limitsurf/surface/pose/padded.h"

namespace limitsurf {

/// 2^exponent for -1022 <= exponent <= 1023. (std::ldexp takes half as long as an evaluation.)
inline double powerOfTwo(int exponent) {
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
  double result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

/// Position and derivatives at one location.
///
/// The position is anchor + patch.value. The anchor is near, so that derivatives are differences of
/// small numbers. Second derivatives have to be multiplied by 2^exponent: close to an extraordinary
/// vertex they, and only they, leave the range of double.
struct Jet {
  Padded anchor;
  PatchValues<Padded> patch;  ///< its value is the offset from the anchor
  int exponent = 0;

  /// Up to here 2^exponent is finite.
  static constexpr int kEasyExponent = 1000;

  /// Changes from the frame of a quad that is turned so that its corner c comes first to the quad's
  /// own frame.
  void turn(int c) {
    if (c == 1 || c == 3) {
      std::swap(patch.du, patch.dv);
      std::swap(patch.duu, patch.dvv);
      patch.duv = -patch.duv;
    }
    if (c == 1 || c == 2) {
      patch.du = -patch.du;
    }
    if (c == 2 || c == 3) {
      patch.dv = -patch.dv;
    }
  }

  /// One of the patch's second derivatives, times 2^exponent.
  Padded second(const Padded& derivative) const {
    if (exponent <= kEasyExponent) {
      return derivative * powerOfTwo(exponent);
    }
    return derivative.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
  }

  /// Changes from the parameters of a quad to those of its parent so many levels up.
  void zoomOut(int levels) {
    if (levels > 0) {
      const double scale = powerOfTwo(levels);
      patch.du *= scale;
      patch.dv *= scale;
      exponent += 2 * levels;
    }
  }
};

/// (u, v) of a quad as seen from its corner c: that corner is (0, 0), the next one (1, 0).
inline void turnParameters(int c, double& u, double& v) {
  const double u0 = u, v0 = v;
  if (c == 1) {
    u = v0;
    v = 1 - u0;
  } else if (c == 2) {
    u = 1 - u0;
    v = 1 - v0;
  } else if (c == 3) {
    u = 1 - v0;
    v = u0;
  }
}

}  // namespace limitsurf
