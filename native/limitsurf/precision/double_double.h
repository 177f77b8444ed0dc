// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "limitsurf/pi.h"

#if defined(__FAST_MATH__) || (defined(_M_FP_FAST) && _M_FP_FAST)
#error "Double-double arithmetic needs the order of operations that the source has: no -ffast-math."
#endif

namespace limitsurf {

/// A sum and its rounding error, or a product and its: value + error is the exact result.
struct Rounded {
  double value, error;
};

/// a + b (Knuth).
constexpr Rounded twoSum(double a, double b) {
  const double sum = a + b, b_part = sum - a, a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// a + b, where |a| >= |b| or a is 0 (Dekker).
constexpr Rounded fastTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a b for factors below 2^996, where the error does not underflow (Dekker, with Veltkamp's
/// splitting into halves of 26 bits).
///
/// A fused multiply-add would give the error at once. But most of the machines that the library is
/// compiled for may lack it, and there std::fma is a function of a hundred operations or more. Both
/// are exact, so that it makes no difference to a result.
constexpr Rounded twoProduct(double a, double b) {
  constexpr double kSplitter = 134217729;  // 2^27 + 1
  const double a_far = kSplitter * a, b_far = kSplitter * b;
  const double a_high = a_far - (a_far - a), b_high = b_far - (b_far - b);
  const double a_low = a - a_high, b_low = b - b_high, product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

/// A number of about 32 digits, as an unevaluated sum of two doubles, of which the first one is the
/// sum rounded to double. Its digits are the same on every machine with IEEE doubles, unlike those
/// of C++'s widest type, which has 53, 64 or 113 bits. Expressions must not be contracted to fused
/// multiply-adds (-ffp-contract=off).
///
/// With u = 2^-53 relative errors are at most
///     3 u^2 (1 + 4 u)  of sums and differences; 5 u^2 of products; 2 u^2 and 3/2 u^2 (1 + 3 u)
///     where one of both is a double; 16 u^2 of quotients,
/// as M. Joldes, J.-M. Muller and V. Popescu ("Tight and rigorous error bounds for basic building
/// blocks of double-word arithmetic", ACM TOMS 44 (2), 2017) and J.-M. Muller and L. Rideau
/// ("Formalization of double-word arithmetic, and comments on ...", ACM TOMS 48 (1), 2022) prove
/// for their algorithms 6, 10, 4, 7 and 17, which these are. Numbers have to be finite, and so far
/// from overflow and underflow that no error term underflows: between 1e-250 and 1e290, or 0.
class DoubleDouble {
 public:
  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high_(value) {}
  template <typename Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  constexpr DoubleDouble(Integer value)
      : high_(static_cast<double>(value)), low_(lowOf(value, high_)) {}

  /// high + low, where `high` is that sum rounded to double.
  static constexpr DoubleDouble ofParts(double high, double low) {
    DoubleDouble result(high);
    result.low_ = low;
    return result;
  }

  constexpr double high() const { return high_; }
  constexpr double low() const { return low_; }
  explicit constexpr operator double() const { return high_; }

  constexpr DoubleDouble operator-() const { return ofParts(-high_, -low_); }

  friend constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const Rounded high = twoSum(a.high_, b.high_), low = twoSum(a.low_, b.low_);
    const Rounded sum = fastTwoSum(high.value, high.error + low.value);
    return normalized(sum.value, low.error + sum.error);
  }
  friend constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const Rounded high = twoProduct(a.high_, b.high_);
    return normalized(high.value, high.error + (a.high_ * b.low_ + a.low_ * b.high_));
  }
  friend constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double quotient = a.high_ / b.high_;
    const DoubleDouble product = b.times(quotient);
    const double rest = (a.high_ - product.high_) + (a.low_ - product.low_);
    return normalized(quotient, rest / b.high_);
  }
  friend constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + -b;
  }

  /// The sum and the product with a double, at half the cost.
  constexpr DoubleDouble plus(double b) const {
    const Rounded high = twoSum(high_, b);
    return normalized(high.value, low_ + high.error);
  }
  constexpr DoubleDouble times(double b) const {
    const Rounded high = twoProduct(high_, b);
    const Rounded sum = fastTwoSum(high.value, low_ * b);
    return normalized(sum.value, sum.error + high.error);
  }

  constexpr DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
  constexpr DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
  constexpr DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
  constexpr DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }

  friend constexpr bool operator==(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high_ == b.high_ && a.low_ == b.low_;
  }
  friend constexpr bool operator!=(const DoubleDouble& a, const DoubleDouble& b) {
    return !(a == b);
  }
  friend constexpr bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high_ < b.high_ || (a.high_ == b.high_ && a.low_ < b.low_);
  }
  friend constexpr bool operator<=(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high_ < b.high_ || (a.high_ == b.high_ && a.low_ <= b.low_);
  }
  friend constexpr bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend constexpr bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }

  friend constexpr DoubleDouble abs(const DoubleDouble& a) { return a.high_ < 0 ? -a : a; }

 private:
  static constexpr DoubleDouble normalized(double high, double low) {
    const Rounded sum = fastTwoSum(high, low);
    return ofParts(sum.value, sum.error);
  }
  /// What rounding to double took from an integer.
  template <typename Integer>
  static constexpr double lowOf(Integer value, double rounded) {
    if constexpr (sizeof(Integer) <= 4) {
      return 0;
    } else {
      // The difference of wide integers may overflow, that of their halves does not.
      constexpr Integer kHalf = Integer{1} << 32;
      const double high = static_cast<double>(value / kHalf) * 4294967296.;
      return (high - rounded) + static_cast<double>(value % kHalf);
    }
  }

  double high_ = 0, low_ = 0;
};

/// The square root of a number that is not negative, with a relative error of at most 25/8 u^2 (V.
/// Lefevre, N. Louvet, J.-M. Muller, J. Picot and L. Rideau, "Accurate calculation of Euclidean
/// norms using double-word arithmetic", ACM TOMS 49 (1), 2023, algorithm 8).
inline DoubleDouble sqrt(const DoubleDouble& a) {
  if (a.high() == 0) {
    return 0;
  }
  const double root = std::sqrt(a.high());
  const Rounded square = twoProduct(root, root);
  const double rest = a.low() + ((a.high() - square.value) - square.error);
  const Rounded sum = fastTwoSum(root, rest / (2 * root));
  return DoubleDouble::ofParts(sum.value, sum.error);
}

inline bool isfinite(const DoubleDouble& a) {
  return std::isfinite(a.high()) && std::isfinite(a.low());
}

template <>
inline constexpr DoubleDouble kPi<DoubleDouble> =
    DoubleDouble::ofParts(0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53);

static_assert(FLT_EVAL_METHOD == 0, "doubles must be evaluated as doubles");

}  // namespace limitsurf
