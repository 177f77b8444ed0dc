// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "limitsurf/pi.h"

namespace limitsurf {

/// cos and sin at multiples of 2 pi / period. The values are exact where their size is 0, 1/2 or 1,
/// and angles that are symmetric on the circle give the same bits up to the sign.
template <typename Real>
class Circle {
 public:
  explicit Circle(std::int64_t period) : period_(period) {}

  Real sin(std::int64_t i) const { return cosQuarters(4 * i - period_); }
  Real cos(std::int64_t i) const { return cosQuarters(4 * i); }

 private:
  /// cos(2 pi q / (4 period)).
  Real cosQuarters(std::int64_t q) const {
    const std::int64_t full = 4 * period_;
    q = ((q % full) + full) % full;
    if (q > full / 2) {
      q = full - q;
    }
    if (q > period_) {
      return -firstQuarter(full / 2 - q);
    }
    return firstQuarter(q);
  }

  Real firstQuarter(std::int64_t q) const {
    if (q == period_) {
      return 0;
    }
    if (3 * q == 2 * period_) {
      return Real(1) / 2;
    }
    const Real unit = kPi<Real> / (2 * static_cast<Real>(period_));
    return 2 * q > period_ ? std::sin(unit * static_cast<Real>(period_ - q))
                           : std::cos(unit * static_cast<Real>(q));
  }

  std::int64_t period_;
};

}  // namespace limitsurf
