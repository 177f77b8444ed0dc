// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace limitsurf {

/// The covariance of a distribution in the plane: the ellipse of a footprint or of a filter.
struct Covariance {
  double xx, xy, yy;

  /// The larger and the smaller of the two principal variances.
  double largest() const { return (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy); }
  double smallest() const { return std::max(0., (xx * yy - xy * xy) / largest()); }

  /// The covariance with its smallest variance raised to `least`, which must be below the largest.
  Covariance widened(double least) const {
    const double large = largest(), small = smallest();
    if (small >= least) {
      return *this;
    }
    // (large I - V) / (large - small) is the projection onto the short axis.
    const double factor = (least - small) / (large - small);
    return {xx + factor * (large - xx), xy - factor * xy, yy + factor * (large - yy)};
  }
};

}  // namespace limitsurf
