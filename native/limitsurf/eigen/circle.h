// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/pi.h"
#include "limitsurf/precision/elementary.h"

namespace limitsurf {

/// cos and sin at multiples of 2 pi / period. The values are exact where their size is 0, 1/2 or 1,
/// and angles that are symmetric on the circle give the same bits up to the sign.
template <typename Real>
class Circle {
 public:
  explicit Circle(std::int64_t period) : period_(period) {}

  Real sin(std::int64_t i) const { return at(i).sin; }
  Real cos(std::int64_t i) const { return at(i).cos; }

  /// Both at the angle 2 pi i / period.
  SineCosine<Real> at(std::int64_t i) const {
    return folded(i, [&](std::int64_t part) { return firstEighth(part); });
  }

  /// at(i) for i = 0, ..., count - 1. What several angles share is computed once.
  std::vector<SineCosine<Real>> first(std::int64_t count) const {
    std::vector<SineCosine<Real>> eighth(static_cast<std::size_t>(period_ / 2 + 1)), result;
    std::vector<bool> known(eighth.size(), false);
    for (std::int64_t i = 0; i < count; ++i) {
      result.push_back(folded(i, [&](std::int64_t part) {
        const auto place = static_cast<std::size_t>(part);
        if (!known[place]) {
          known[place] = true;
          eighth[place] = firstEighth(part);
        }
        return eighth[place];
      }));
    }
    return result;
  }

 private:
  /// The values at an angle, by its symmetry to an angle of the first eighth of the circle.
  template <typename FirstEighth>
  SineCosine<Real> folded(std::int64_t i, const FirstEighth& first_eighth) const {
    const std::int64_t full = 4 * period_, turn = ((4 * i) % full + full) % full;
    const std::int64_t in_quarter = turn % period_;  // of period_ parts
    SineCosine<Real> result = 2 * in_quarter > period_
                                  ? exchanged(first_eighth(period_ - in_quarter))
                                  : first_eighth(in_quarter);
    switch (turn / period_) {
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

  static SineCosine<Real> exchanged(const SineCosine<Real>& x) { return {x.cos, x.sin}; }

  /// At the angle (pi / 2) i / period, i <= period / 2.
  SineCosine<Real> firstEighth(std::int64_t i) const {
    if (i == 0) {
      return {0, 1};
    }
    const Real angle = kPi<Real> * static_cast<Real>(i) / (2 * static_cast<Real>(period_));
    SineCosine<Real> result = sineCosine(angle);
    if (3 * i == period_) {
      result.sin = Real(1) / 2;
    }
    if (2 * i == period_) {
      result.sin = result.cos;
    }
    return result;
  }

  std::int64_t period_;
};

}  // namespace limitsurf
