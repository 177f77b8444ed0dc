// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/pose/padded.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// How large control points are.
struct PointsSize {
  double extent = 0;              ///< the longest side of their bounding box
  double largest_coordinate = 0;  ///< of any of them
};

/// Copies control points into padded ones, and returns how large they are.
PointsSize padPoints(const RowsIn<Points>& from, Padded* to, int threads);

}  // namespace limitsurf
