// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "limitsurf/sample/density_field.h"

namespace limitsurf {

/// The radii of discs: larger where the density is smaller.
class NoiseRadii {
 public:
  /// `radius` is that where the density is largest. A radius beyond the surface's own size makes no
  /// difference.
  NoiseRadii(const DensityField& density, double radius, double diagonal)
      : density_(density),
        radius_(radius),
        largest_(density.isConstant() ? radius : std::max(radius, 4 * diagonal)) {}

  double smallest() const { return radius_; }
  double largest() const { return largest_; }

  bool areEqual() const { return density_.isConstant(); }
  /// The radius at a location, or 0 where the density is 0.
  double at(const Location& location) const {
    const double weight = density_.at(location);
    return weight > 0 ? of(weight) : 0;
  }
  /// Computes the smallest radius on the rectangle that on() returns. Returns false where the
  /// density is 0 throughout.
  template <typename Rectangle>
  bool smallestOn(const Rectangle& on, double& radius) const {
    radius = radius_;
    if (areEqual()) {
      return true;
    }
    const double weight = density_.largestOn(on());
    radius = of(weight);
    return weight > 0;
  }

 private:
  double of(double weight) const {
    return weight >= 1 ? radius_ : std::min(radius_ / std::sqrt(weight), largest_);
  }

  const DensityField& density_;
  double radius_, largest_;
};

}  // namespace limitsurf
