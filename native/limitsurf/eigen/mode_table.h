// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// One mode on one face: its values at the outer slots before a step, and on the whole grid after
/// that step.
struct ModeTable {
  double outer[tile_grid::kOuter] = {};
  double grid[tile_grid::kSlots] = {};
};

}  // namespace limitsurf
