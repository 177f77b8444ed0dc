// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf {

/// Curves as points with straight lines between them. Curve i has the points offsets[i] to
/// offsets[i + 1] - 1; a closed curve ends with its first point.
struct Polylines {
  Points points;
  std::vector<std::int64_t> offsets;
};

/// Throws std::invalid_argument for offsets that do not begin with 0, decrease, or do not end with
/// the number of points; and naming the first point that is not finite. The names are what messages
/// call the two arrays.
void checkPolylines(const Polylines& curves, const char* points_name, const char* offsets_name);

}  // namespace limitsurf
