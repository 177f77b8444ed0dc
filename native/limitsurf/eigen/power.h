// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// base^exponent, by repeated squaring; `one` is the unit of the multiplication.
template <typename Number>
Number power(Number base, int exponent, Number one) {
  for (; exponent > 0; exponent >>= 1, base = base * base) {
    if (exponent & 1) {
      one = one * base;
    }
  }
  return one;
}

}  // namespace limitsurf
