// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/tiles/surface_tiles.h"
#include "limitsurf/surface/tiles/tile_control_points.h"

namespace limitsurf {

/// The rows of weights of a SurfaceTiles' refined points, in which equal rows are found: a table of
/// hashes and numbers only, because a tile has up to 17 rows, and to free a string for each of them
/// would take longer than a call may be deaf.
class PointRows {
 public:
  /// Refers to the tiles, to which it adds rows.
  explicit PointRows(SurfaceTiles& tiles) : tiles_(tiles), slots_(kFewSlots, -1) {}

  /// The number of the refined point with these weights, bit for bit, from 0 on. It is added if
  /// there is none.
  int numberOf(const CageRow& row);

 private:
  static constexpr std::size_t kFewSlots = 1024;  // a power of two

  bool isRow(int number, const CageRow& row) const;
  void add(const CageRow& row);
  void doubleSlots();

  SurfaceTiles& tiles_;
  std::vector<std::uint64_t> hashes_;  // per row
  std::vector<int> slots_;  // by hash, then the next free one: the number of a row, or -1
};

}  // namespace limitsurf
