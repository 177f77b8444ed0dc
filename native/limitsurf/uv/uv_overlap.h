// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/uv/uv_inverse.h"

namespace limitsurf {

/// A find on the border of its cell, one of those at a lattice point.
struct BorderFind {
  std::int64_t point;
  int wedge_count;
  Wedge wedges[2];
};

/// Whether the images of cells around a point overlap; the wedges of each find give the image of
/// its cell. The images of neighbouring cells only touch.
bool doWedgesOverlap(const BorderFind* begin, const BorderFind* end);

}  // namespace limitsurf
