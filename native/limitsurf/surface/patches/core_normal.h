// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/surface/jet.h"

namespace limitsurf {

/// The integral of ds x dt over a whole core, of which the areas of its patches add up to a little
/// more. It is a sum of cross products of pairs of the control points.
///
/// With A for a subdivision step (Stam) and Q for the form of the three patches that a step leaves,
/// the form of the core is the sum of (A^n)' Q A^n over all n. Each doubling of the number of its
/// terms takes three products of matrices; the terms fall as those areas do.
class CoreNormal {
 public:
  /// O(valence^3).
  CoreNormal(const Eigenbasis& basis, int face);

  struct Value {
    Vector3 normal;
    double rounding;  ///< more than the rounding error of its length
  };
  /// From the ring's points and then the outer points, relative to any point near them.
  /// O(valence^2).
  Value value(const Padded points[]) const;

 private:
  std::size_t size_ = 0;         // the number of points
  std::vector<double> factors_;  // of p_i x p_j, i < j, row by row
  double sum_ = 0;               // of their absolute values
};

}  // namespace limitsurf
