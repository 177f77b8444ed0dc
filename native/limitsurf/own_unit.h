// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace limitsurf {

/// The power of two that brings a length to between 1 and 2; 1 for a length of 0. Multiplied by it,
/// lengths keep all their digits, and products of several of them neither overflow nor underflow.
inline double scaleToOwnUnit(double length) {
  return length > 0 && std::isfinite(length) ? std::ldexp(1., -std::ilogb(length)) : 1;
}

}  // namespace limitsurf
