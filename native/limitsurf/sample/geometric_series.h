// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace limitsurf {

/// The limit of a sequence whose differences approach a sum of geometric sequences, by Aitken's
/// extrapolation (the delta-squared process), applied twice.
class GeometricSeries {
 public:
  void add(double value) {
    const double once = once_.add(value);
    const double before = limit_;
    limit_ = twice_.add(once);
    // Two estimates may agree by accident, but hardly three.
    const double change = std::abs(limit_ - before);
    error_ = std::max(change, change_ / kCaution);
    change_ = change;
  }

  double limit() const { return limit_; }
  /// The last change of limit(), which is far larger than its error where the terms are as assumed.
  double error() const { return error_; }

 private:
  /// One application: to a sequence, given value by value.
  class Aitken {
   public:
    double add(double value) {
      const double difference = value - last_;
      double limit = value;
      if (std::abs(difference) < kSlowest * std::abs(difference_)) {
        limit += difference * difference / (difference_ - difference);
      }
      last_ = value;
      difference_ = difference;
      return limit;
    }

   private:
    /// Sequences that converge more slowly than that are not extrapolated.
    static constexpr double kSlowest = 0.9;

    double last_ = 0, difference_ = 0;
  };

  static constexpr double kCaution = 2;

  Aitken once_, twice_;
  double limit_ = 0, error_ = 0, change_ = 0;
};

}  // namespace limitsurf
