// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace limitsurf {

/// The indices 0 to 3 in the order of their values; equal values stay in the order of their
/// indices.
inline std::array<int, 4> ascending(const double values[4]) {
  std::array<int, 4> order = {0, 1, 2, 3};
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return values[i] != values[j] ? values[i] < values[j] : i < j; });
  return order;
}

/// A polynomial of degree N in s and in t on the unit square, by its Bernstein coefficients (i
/// counts along s, j along t). The coefficients bound the polynomial, and those at the corners are
/// its values there.
template <int N>
class Bernstein {
 public:
  static constexpr int kSize = N + 1;
  /// Rows are padded to whole registers; the padding repeats the last coefficient.
  static constexpr int kStride = kSize + (kSize & 1);

  double& at(int i, int j) { return c_[kStride * j + i]; }
  double at(int i, int j) const { return c_[kStride * j + i]; }
  /// All coefficients, row by row with their padding.
  double* data() { return c_; }
  const double* data() const { return c_; }
  /// The coefficients along s, for one j.
  const double* row(int j) const { return c_ + kStride * j; }
  /// Sets the padding. Must be called after coefficients have been set one by one.
  void pad() {
    for (int j = 0; j < kSize; ++j) {
      c_[kStride * j + kStride - 1] = c_[kStride * j + N];
    }
  }

  double least() const { return all().minCoeff(); }
  double largest() const { return all().maxCoeff(); }

  /// The polynomial on the square's quarters, by de Casteljau's algorithm: out[0] at (0, 0), out[1]
  /// at (1/2, 0), out[2] at (0, 1/2), out[3] at (1/2, 1/2).
  void quarter(Bernstein out[4]) const {
    halveAlongS(out[0], out[1]);
    out[0].halveAlongT(out[0], out[2]);
    out[1].halveAlongT(out[1], out[3]);
  }
  /// The polynomial on the halves of the square where s is low and where it is high.
  void halveAlongS(Bernstein& low, Bernstein& high) const {
    for (int j = 0; j < kSize; ++j) {
      double p[kSize];
      for (int i = 0; i < kSize; ++i) {
        p[i] = at(i, j);
      }
      halve(
          p, [&](int i, double x) { low.at(i, j) = x; },
          [&](int i, double x) { high.at(i, j) = x; });
    }
    low.pad();
    high.pad();
  }
  /// The same for t. One of the halves may be this polynomial itself.
  void halveAlongT(Bernstein& low, Bernstein& high) const {
    Row p[kSize];
    for (int j = 0; j < kSize; ++j) {
      p[j] = vector(j);
    }
    halve(
        p, [&](int j, const Row& x) { low.vector(j) = x; },
        [&](int j, const Row& x) { high.vector(j) = x; });
  }

  /// Splits a polynomial of one parameter in the middle, by de Casteljau's algorithm: calls
  /// low(i, coefficient) and high(i, coefficient) with those of both halves. `p` holds the
  /// coefficients, and is overwritten.
  template <typename Value, typename Low, typename High>
  [[gnu::always_inline]] static inline void halve(Value p[kSize], const Low& low,
                                                  const High& high) {
#pragma GCC unroll 8
    for (int level = 0; level <= N; ++level) {
      low(level, p[0]);
      high(N - level, p[N - level]);
#pragma GCC unroll 8
      for (int i = 0; i < N - level; ++i) {
        p[i] = 0.5 * (p[i] + p[i + 1]);
      }
    }
  }

 private:
  using Row = Eigen::Array<double, kStride, 1>;

  Eigen::Map<const Eigen::Array<double, kStride * kSize, 1>, Eigen::Aligned16> all() const {
    return Eigen::Map<const Eigen::Array<double, kStride * kSize, 1>, Eigen::Aligned16>(c_);
  }
  Eigen::Map<const Row, Eigen::Aligned16> vector(int j) const {
    return Eigen::Map<const Row, Eigen::Aligned16>(c_ + kStride * j);
  }
  Eigen::Map<Row, Eigen::Aligned16> vector(int j) {
    return Eigen::Map<Row, Eigen::Aligned16>(c_ + kStride * j);
  }

  alignas(16) double c_[kStride * kSize];
};

}  // namespace limitsurf
