// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/precision/double_double.h"

namespace limitsurf {

/// A sum of products of double-doubles, at half the cost of one operation after the other: rounding
/// errors are summed in double, and the result is normalised once. (T. Ogita, S. M. Rump and S.
/// Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26 (6), 2005, for double-doubles.)
/// For n products the error is at most (n + 6) (n + 2) u^2 times the sum of their sizes, u = 2^-53.
class SumOfProducts {
 public:
  void add(const DoubleDouble& a, const DoubleDouble& b) {
    addProduct(a.high(), b.high(), a.high() * b.low() + a.low() * b.high());
  }
  void add(const DoubleDouble& a, double b) { addProduct(a.high(), b, a.low() * b); }

  DoubleDouble sum() const {
    const Rounded sum = twoSum(value_, error_);
    return DoubleDouble::ofParts(sum.value, sum.error);
  }

 private:
  void addProduct(double a, double b, double rest) {
    const Rounded product = twoProduct(a, b), sum = twoSum(value_, product.value);
    value_ = sum.value;
    error_ += (sum.error + product.error) + rest;
  }

  double value_ = 0, error_ = 0;
};

}  // namespace limitsurf
