// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "limitsurf/eigen/dart_vectors.h"

// Vectors on a dart's ring that are symmetric about its sharp spoke, point by point: one value for
// each place n = 0, ..., N (dart_wave.h), and the value at the vertex last.

namespace limitsurf {

/// How many points of a ring of `faces` faces share the place n: one on the axis, else two.
inline int placeMultiplicity(int n, int faces) { return n == 0 || n >= faces ? 1 : 2; }

template <typename Scalar, typename Wave>
std::vector<Scalar> placesOf(const DartVector<Scalar>& vector, const Wave& wave, int faces) {
  std::vector<Scalar> result;
  for (int n = 0; n <= faces; ++n) {
    result.push_back(vector.at(n, faces, wave.value(n)));
  }
  result.push_back(vector.vertex);
  return result;
}

/// The product of a left and a right vector, as a sum over all points of the ring.
template <typename Scalar>
Scalar productOfPlaces(const std::vector<Scalar>& left, const std::vector<Scalar>& right) {
  using Real = RealOf<Scalar>;
  const int faces = static_cast<int>(left.size()) - 2;
  Scalar sum = 0;
  for (int n = 0; n <= faces + 1; ++n) {
    sum += static_cast<Real>(placeMultiplicity(n, faces)) * left[n] * right[n];
  }
  return sum;
}

template <typename Real>
Real largestOfPlaces(const std::vector<Real>& places) {
  using std::abs;
  Real result = 0;
  for (const Real& value : places) {
    result = std::max<Real>(result, abs(value));
  }
  return result;
}

template <typename Scalar, typename Factor>
void scalePlaces(std::vector<Scalar>& places, const Factor& factor) {
  for (Scalar& value : places) {
    value *= factor;
  }
}

}  // namespace limitsurf
