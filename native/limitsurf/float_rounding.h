// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace limitsurf {

/// A float that is not below `value`, for upper bounds in single precision.
inline float roundedUp(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

/// A float that is not above `value`.
inline float roundedDown(double value) { return -roundedUp(-value); }

}  // namespace limitsurf
