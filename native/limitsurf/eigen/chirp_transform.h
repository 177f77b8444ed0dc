// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace limitsurf {

/// The discrete Fourier transform of n values, in O(n log n) operations for every n: the chirp
/// transform of L. Bluestein, "A linear filtering approach to the computation of the discrete
/// Fourier transform", 1970. Because 2 i m = i^2 + m^2 - (m - i)^2, the transform is a convolution
/// with the chirp exp(i pi j^2 / n). Transforms whose length is a power of two compute it.
///
/// The error is about 1e-16 log n of the root mean square of the results: less than that of n sums,
/// one after the other.
class ChirpTransform {
 public:
  /// `cos` and `sin` hold one period of 2 n values: cos(pi i / n) and sin(pi i / n).
  ChirpTransform(const std::vector<double>& cos, const std::vector<double>& sin);

  /// n.
  std::size_t count() const { return chirp_.size(); }

  /// Replaces the values x_i = re_i + i im_i by the sums over i of x_i exp(-2 pi i i m / n), for m
  /// from 0 to n - 1. A Value is a number or an array of numbers. The vectors are given back longer
  /// than n.
  template <typename Value>
  void apply(std::vector<Value>& re, std::vector<Value>& im) const {
    for (std::size_t i = 0; i < count(); ++i) {
      multiply(chirp_[i].cos, -chirp_[i].sin, re[i], im[i]);
    }
    const Value zero = 0 * re[0];
    re.resize(count());
    im.resize(count());
    re.resize(kernel_.size(), zero);
    im.resize(kernel_.size(), zero);
    forward(re.data(), im.data(), kernel_.size(), 1);
    for (std::size_t i = 0; i < kernel_.size(); ++i) {
      multiply(kernel_[i].cos, kernel_[i].sin, re[i], im[i]);
    }
    backward(re.data(), im.data(), kernel_.size(), 1);
    for (std::size_t m = 0; m < count(); ++m) {
      multiply(chirp_[m].cos, -chirp_[m].sin, re[m], im[m]);
    }
  }

 private:
  struct Factor {
    double cos, sin;
  };

  template <typename Value>
  static void multiply(double cos, double sin, Value& re, Value& im) {
    const Value old = re;
    re = cos * old - sin * im;
    im = sin * old + cos * im;
  }

  /// The transform of a power of two, which leaves its results in bit-reversed order (Cooley and
  /// Tukey 1965, decimation in frequency). It halves the range again and again, so that most of the
  /// work is done in the cache.
  template <typename Value>
  void forward(Value* re, Value* im, std::size_t size, std::size_t stride) const {
    const std::size_t half = size / 2;
    for (std::size_t i = 0; i < half; ++i) {
      const Value re_difference = re[i] - re[i + half], im_difference = im[i] - im[i + half];
      re[i] = re[i] + re[i + half];
      im[i] = im[i] + im[i + half];
      re[i + half] = re_difference;
      im[i + half] = im_difference;
      multiply(roots_[i * stride].cos, -roots_[i * stride].sin, re[i + half], im[i + half]);
    }
    if (half > 1) {
      forward(re, im, half, 2 * stride);
      forward(re + half, im + half, half, 2 * stride);
    }
  }

  /// From bit-reversed to natural order: `size` times the inverse of forward().
  template <typename Value>
  void backward(Value* re, Value* im, std::size_t size, std::size_t stride) const {
    const std::size_t half = size / 2;
    if (half > 1) {
      backward(re, im, half, 2 * stride);
      backward(re + half, im + half, half, 2 * stride);
    }
    for (std::size_t i = 0; i < half; ++i) {
      multiply(roots_[i * stride].cos, roots_[i * stride].sin, re[i + half], im[i + half]);
      const Value re_difference = re[i] - re[i + half], im_difference = im[i] - im[i + half];
      re[i] = re[i] + re[i + half];
      im[i] = im[i] + im[i + half];
      re[i + half] = re_difference;
      im[i + half] = im_difference;
    }
  }

  std::vector<Factor> chirp_;   // exp(i pi i^2 / n)
  std::vector<Factor> roots_;   // of 1, of the order of the convolution: its first half
  std::vector<Factor> kernel_;  // the transform of the chirp, over its length
};

}  // namespace limitsurf
