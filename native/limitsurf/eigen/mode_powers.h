// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/dart_modes.h"
#include "limitsurf/eigen/power.h"

// Powers of the Jordan form J: what many subdivision steps do to a mode. A power costs
// O(log(steps)) products. Where 2^steps belongs to the result it is multiplied in step by step,
// because (2 lambda)^steps stays within the range of double where lambda^steps does not.

namespace limitsurf {

inline double power(double base, int exponent) { return power(base, exponent, 1.); }

/// The number p + q E with E^2 = `square`: a step multiplies a pair of modes by mean + E, with
/// E^2 = forth back (see ModePair).
struct PairNumber {
  double p, q, square;

  friend PairNumber operator*(const PairNumber& a, const PairNumber& b) {
    return {a.p * b.p + a.square * a.q * b.q, a.p * b.q + a.q * b.p, a.square};
  }
};

/// (scale (mean + E))^exponent.
inline PairNumber pairPower(const ModePair& pair, double scale, int exponent) {
  const double square = pair.forth * pair.back;
  return power(PairNumber{scale * pair.mean, scale, square}, exponent, PairNumber{1, 0, square});
}

/// The matrix [lambda, feeds; 0, outer]: what a step does to a mode that feeds an outer mode.
struct FeedNumber {
  double lambda, feeds, outer;

  friend FeedNumber operator*(const FeedNumber& a, const FeedNumber& b) {
    return {a.lambda * b.lambda, a.lambda * b.feeds + a.feeds * b.outer, a.outer * b.outer};
  }
};

/// 2^steps times what a mode has fed into an outer mode after `steps` steps, if a step feeds 1.
inline double scaledFeed(double lambda, double outer, int steps) {
  return power(FeedNumber{2 * lambda, 2, 2 * outer}, steps, FeedNumber{1, 0, 1}).feeds;
}

}  // namespace limitsurf
