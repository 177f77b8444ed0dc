// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Points along curves, one curve after the other. The curves' vertices are among them, because a
/// curve may have a corner there or end.
struct CurveSamples {
  /// Neighbours are at most `spacing` apart, and an edge has at least three parts: where it turns
  /// by no more than 90 degrees, the curve is within `spacing` / 15 of the chords between them.
  /// Throws std::invalid_argument where there would be too many.
  CurveSamples(const EdgeCurves& curves, double spacing, int threads);

  Points positions;
  std::vector<int> next, before;  ///< on the same curve, or -1
  std::vector<int> vertex;        ///< the control mesh's vertex at the sample, or -1
};

}  // namespace limitsurf
