// SPDX-License-Identifier: Apache-2.0
#include "support/truth/accuracy.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace limitsurf::test {
namespace {

constexpr long kFailuresShown = 3;  // per surface and quantity

std::string text(const Vector3& v) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, "(%.17g, %.17g, %.17g)", v.x(), v.y(), v.z());
  return buffer;
}

/// Length without overflow or underflow of the squares.
double length(const Vector3& v) { return v.stableNorm(); }

}  // namespace

Truth truthOf(const Golden& golden, int sample) {
  Truth truth;
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    truth.values[quantity] = golden.values[quantity].row(sample);
  }
  return truth;
}

Truth rowOf(const Evaluation& evaluation, int row) {
  const Points* const quantities[kQuantities] = {
      &evaluation.position, &evaluation.du,  &evaluation.dv,    &evaluation.duu,
      &evaluation.duv,      &evaluation.dvv, &evaluation.normal};
  Truth result;
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    if (quantities[quantity]->rows() > row) {
      result.values[quantity] = quantities[quantity]->row(row);
    } else {
      result.values[quantity].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return result;
}

Truth upTo(Derivatives order, Truth truth) {
  for (int quantity = kDu; quantity < kQuantities; ++quantity) {
    const bool second = quantity >= kDuu && quantity <= kDvv;
    if (order < (second ? Derivatives::second : Derivatives::first)) {
      truth.values[quantity].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return truth;
}

double allowedError(int quantity) {
  switch (quantity) {
    case kPosition:
      return kPositionError;
    case kDu:
    case kDv:
      return kFirstDerivativeError;
    case kNormal:
      return kNormalError;
    default:
      return kSecondDerivativeError;
  }
}

double angle(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

bool awayFromCorners(const Location& at) {
  const double u = std::min(at.u, 1 - at.u), v = std::min(at.v, 1 - at.v);
  return std::max(u, v) >= 1.0 / 16;
}

void Accuracy::addScale(const Location& at, const Truth& truth) {
  if (!awayFromCorners(at)) return;
  std::array<double, 2>& scale = scales_[at.face];
  for (int quantity = kDu; quantity <= kDvv; ++quantity) {
    const double size = length(truth[quantity]);
    double& largest = scale[quantity > kDv];
    if (size > largest) largest = size;  // not where it is NaN
  }
}

double Accuracy::error(const Location& at, int quantity, const Vector3& got,
                       const Vector3& truth) const {
  if (!got.allFinite()) return std::numeric_limits<double>::infinity();
  if (quantity == kPosition) return length(got - truth) / diagonal_;
  if (quantity == kNormal) return angle(got, truth) + std::abs(got.norm() - 1);
  const auto scale = scales_.find(at.face);
  const double largest = scale == scales_.end() ? 0 : scale->second[quantity > kDv];
  const double difference = length(got - truth);
  return difference == 0 ? 0 : difference / std::max(length(truth), largest);
}

void Accuracy::check(const Location& at, const Truth& got, const Truth& truth) {
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    if (truth[quantity].hasNaN()) continue;
    Worst& worst = worst_[quantity];
    ++worst.compared;
    const double e = error(at, quantity, got[quantity], truth[quantity]);
    if (!(e <= worst.error)) {
      worst.error = e;
      worst.where = describe(at);
    }
    if (!(e <= allowedError(quantity)) && worst.failed++ < kFailuresShown) {
      ADD_FAILURE() << name_ << ", " << describe(at) << ": " << kQuantityNames[quantity]
                    << "\n  is        " << text(got[quantity]) << "\n  should be "
                    << text(truth[quantity]) << "\n  error " << e << ", allowed "
                    << allowedError(quantity);
    }
  }
}

void Accuracy::merge(const Accuracy& other) {
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    Worst& mine = worst_[quantity];
    const Worst& theirs = other.worst_[quantity];
    mine.compared += theirs.compared;
    mine.failed += theirs.failed;
    if (theirs.error > mine.error) {
      mine.error = theirs.error;
      mine.where = other.name_ + ", " + theirs.where;
    }
  }
}

std::string Accuracy::summary() const {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer,
                "%-32s P %.1e  du %.1e  dv %.1e  duu %.1e  duv %.1e  dvv %.1e  n %.1e",
                name_.c_str(), worst(kPosition), worst(kDu), worst(kDv), worst(kDuu), worst(kDuv),
                worst(kDvv), worst(kNormal));
  return buffer;
}

std::string Accuracy::details() const {
  std::string result;
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    const Worst& worst = worst_[quantity];
    char buffer[400];
    std::snprintf(buffer, sizeof buffer,
                  "  %-8s worst %.2e of %.0e allowed, %ld compared, %ld failed; %s\n",
                  kQuantityNames[quantity], worst.error, allowedError(quantity), worst.compared,
                  worst.failed, worst.where.c_str());
    result += buffer;
  }
  return result;
}

}  // namespace limitsurf::test
