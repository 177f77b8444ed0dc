// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <string>

#include "support/truth/golden.h"

namespace limitsurf::test {

/// True values at one location; NaN where there is none to compare with.
struct Truth {
  std::array<Vector3, kQuantities> values;

  const Vector3& operator[](int quantity) const { return values[quantity]; }
};

/// Sample `sample` of golden values.
Truth truthOf(const Golden& golden, int sample);

/// Row `row` of a batch, as the seven quantities; NaN where the batch has none.
Truth rowOf(const Evaluation& evaluation, int row);

/// Without what an evaluation to that order does not give.
Truth upTo(Derivatives order, Truth truth);

/// The evaluator may take another way for each order: what is compared, is compared in all three.
constexpr Derivatives kOrders[] = {Derivatives::none, Derivatives::first, Derivatives::second};

/// The allowed error of each quantity (limit_surface.h).
double allowedError(int quantity);

/// Angle between two unit vectors, precise where it is small.
double angle(const Vector3& a, const Vector3& b);

/// Holds evaluations of one surface to the promised accuracy, and keeps the worst figures.
///
/// First and second derivatives are measured relative to the larger of the value itself and the
/// face's scale, its largest derivative of that order at least 1/16 away from its corners: give
/// those truths to addScale() first.
class Accuracy {
 public:
  Accuracy(std::string name, double diagonal) : name_(std::move(name)), diagonal_(diagonal) {}

  void addScale(const Location& at, const Truth& truth);
  /// Fails the test, naming surface, location, quantity, both values and the error, where one is
  /// too large. Quantities whose truth is NaN are passed over.
  void check(const Location& at, const Truth& got, const Truth& truth);

  double worst(int quantity) const { return worst_[quantity].error; }
  /// Takes over the worst figures of another surface.
  void merge(const Accuracy& other);
  /// One line of the worst figures.
  std::string summary() const;
  /// One line per quantity: worst figure, where, how many locations were compared.
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
