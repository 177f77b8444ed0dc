// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "limitsurf/patch/refinement_level.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/patch/window.h"

namespace limitsurf {

/// Makes the ring tiles of a table and the rings that they share.
class RingTileMaker {
 public:
  /// Refers to both, which must outlive it. `levels`: the cage first.
  RingTileMaker(TileTable& table, std::vector<std::unique_ptr<RefinementLevel>>& levels)
      : table_(table), levels_(levels) {}

  /// The tile of a quad with its irregular corner `at`. `diagonal`: as Window takes it.
  RingTile make(int level, FaceCorner at, const std::array<bool, 4>& diagonal);

 private:
  int outerPoint(FaceMesh& mesh, const Window& window, int x, int y);
  RefinementLevel::RingAge ringOf(int level, int sector);
  RingPoints makeRing(FaceMesh& mesh, const Sector& sector);

  TileTable& table_;
  std::vector<std::unique_ptr<RefinementLevel>>& levels_;
  std::map<Ring, std::shared_ptr<const Eigenbasis>> bases_;
  std::map<std::pair<int, int>, int> reflections_;
};

/// Orders the ring tiles of a table by their ring, so that what is computed for a ring serves its
/// tiles one after the other.
void groupByRing(TileTable& table);

}  // namespace limitsurf
