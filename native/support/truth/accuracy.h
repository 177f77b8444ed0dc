// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>

#include "support/truth/golden.h"

namespace limitsurf::test {

/// True values at one location; NaN where there is no value to compare with.
struct Truth {
  std::array<Vector3, kQuantities> values;

  const Vector3& operator[](int quantity) const { return values[quantity]; }
};

/// Sample `sample` of golden values.
Truth truthOf(const Golden& golden, int sample);

/// Row `row` of a batch, as the seven quantities; NaN where the batch has none.
Truth rowOf(const Evaluation& evaluation, int row);

/// The truth without the quantities that an evaluation to that order does not give.
Truth upTo(Derivatives order, Truth truth);

/// The evaluator may compute each order of derivatives in its own way, so that tests compare all
/// three.
constexpr Derivatives kOrders[] = {Derivatives::none, Derivatives::first, Derivatives::second};

/// The allowed error of each quantity (limit_surface.h).
double allowedError(int quantity);

/// Angle between two unit vectors, precise where it is small.
double angle(const Vector3& a, const Vector3& b);

/// Compares evaluations of one surface with the truth, and keeps the worst errors.
///
/// First and second derivatives are measured relative to the larger of the value itself and the
/// face's scale, its largest derivative of that order at least 1/16 away from its corners: give
/// those truths to addScale() first.
class Accuracy {
 public:
  Accuracy(std::string name, double diagonal) : name_(std::move(name)), diagonal_(diagonal) {}

  void addScale(const Location& at, const Truth& truth);
  /// Fails the test where an error is too large, and names surface, location, quantity, both values
  /// and the error. Quantities whose truth is NaN are left out.
  void check(const Location& at, const Truth& got, const Truth& truth);

  double worst(int quantity) const { return worst_[quantity].error; }
  /// Includes the worst errors of another surface.
  void merge(const Accuracy& other);
  /// Prints one line with the worst errors.
  std::string summary() const;
  /// Prints one line per quantity: the worst error, where it is, and how many locations were
  /// compared.
  std::string details() const;

 private:
  struct Worst {
    double error = 0;
    long compared = 0;
    long failed = 0;
    std::string where;
  };
  double error(const Location& at, int quantity, const Vector3& got, const Vector3& truth) const;

  std::string name_;
  double diagonal_;
  std::map<int, std::array<double, 2>> scales_;  // face -> largest first, second derivative
  std::array<Worst, kQuantities> worst_;
};

/// Whether the location is at least 1/16 away from each corner of its face.
bool awayFromCorners(const Location& at);

}  // namespace limitsurf::test
