// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// One mode on one face: its values at the outer cells before, on the whole grid after a step.
struct ModeTable {
  double outer[tile_grid::kOuter] = {};
  double grid[tile_grid::kCells] = {};
};

}  // namespace limitsurf
