// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

namespace limitsurf {

/// The least float that is not below `value`, for upper bounds in single precision; NaN for NaN.
inline float roundedUp(double value) {
  static_assert(sizeof(float) == sizeof(std::uint32_t));
  const auto nearest = static_cast<float>(value);
  if (!(double{nearest} < value)) {
    return nearest;
  }
  // The bits of floats count upwards from zero and downwards below it. std::nextafter is a call
  // into the C library, which takes as long as a box test.
  std::uint32_t bits;
  std::memcpy(&bits, &nearest, sizeof bits);
  bits += nearest < 0 ? -1u : 1u;
  float next;
  std::memcpy(&next, &bits, sizeof next);
  return next;
}

/// The largest float that is not above `value`.
inline float roundedDown(double value) { return -roundedUp(-value); }

}  // namespace limitsurf
