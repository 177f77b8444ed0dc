// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/ring.h"
#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// Calls visit(grid cell, ring point) for the ring's points next to one of its faces, up to its
/// sharp sides.
template <typename Visit>
void forEachRingCell(const Ring& ring, int face, const Visit& visit) {
  using tile_grid::cell;
  const int k = ring.faces;
  visit(cell(0, 0), 0);
  visit(cell(1, 0), ring.edge(face));
  visit(cell(1, 1), ring.face(face));
  visit(cell(0, 1), ring.nextEdge(face));
  const Sides sides = ring.sides(face);
  if (!onLeft(sides)) {
    const int before = (face + k - 1) % k;
    visit(cell(0, -1), ring.edge(before));
    visit(cell(1, -1), ring.face(before));
  }
  if (!onRight(sides)) {
    const int after = (face + 1) % k;
    visit(cell(-1, 1), ring.face(after));
    visit(cell(-1, 0), ring.nextEdge(after));
  }
}

}  // namespace limitsurf
