// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/pose/pose.h"

namespace limitsurf {

/// What regular tiles and ring tiles need. They may be given several times. Cost: O(n log n) for n
/// tiles and points, and a bit for each refined point of the table.
PosePart posePart(const TileTable& table, std::vector<TileRef> tiles);

}  // namespace limitsurf
