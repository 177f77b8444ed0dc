// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace limitsurf {

/// The exponent of the largest power of two that is at most the length; 0 for a length that is 0 or
/// not finite.
inline int exponentOf(double length) {
  return length > 0 && std::isfinite(length) ? std::ilogb(length) : 0;
}

/// The power of two that brings a length to between 1 and 2; 1 for a length of 0. Multiplied by it,
/// lengths keep all their digits, and products of several of them neither overflow nor underflow.
/// (For lengths below 2^-1023, which have few digits, it is 2^1023: there is no larger one.)
inline double scaleToOwnUnit(double length) {
  return std::ldexp(1., std::min(-exponentOf(length), 1023));
}

}  // namespace limitsurf
