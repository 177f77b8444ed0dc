// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/tile_table.h"

namespace limitsurf {

/// The points and rings of a table that some of its tiles need.
struct PosePart {
  PosePart() = default;
  /// What regular tiles and ring tiles need. They may be given several times. Cost: O(n log n) for
  /// n tiles and points.
  PosePart(const TileTable& table, std::vector<TileRef> tiles);

  std::vector<int> points;  ///< refined points, each after those that it is made of
  std::vector<int> rings;
};

}  // namespace limitsurf
