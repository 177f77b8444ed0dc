// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/sample/area_cells.h"
#include "limitsurf/sample/density_limits.h"

namespace limitsurf {

/// Cells with the largest limit of a density on each, as a part of the largest one on all of them,
/// rounded up to single precision.
struct LimitedCells {
  std::vector<AreaCell> cells;
  std::vector<float> largest;
  double unit = 0;  ///< the largest limit on all cells
};

/// The cells on which the density may be above 0. Cells of patches are split until the limits are
/// the same on all of a cell, or the cell is no larger than a square that has a limit. Throws
/// std::invalid_argument naming a limit that is negative or not finite.
LimitedCells limitedCells(const SurfacePatches& patches, const std::vector<AreaCell>& cells,
                          const DensityLimits& limits, int threads);

}  // namespace limitsurf
