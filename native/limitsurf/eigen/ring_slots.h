// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/ring.h"
#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// Calls visit(slot, point) for the points of the ring that have a slot in the grid of one of its
/// faces. Points beyond a sharp side of the face have none.
template <typename Visit>
void forEachRingSlot(const Ring& ring, int face, const Visit& visit) {
  using tile_grid::slot;
  const int k = ring.faces;
  visit(slot(0, 0), 0);
  visit(slot(1, 0), ring.edge(face));
  visit(slot(1, 1), ring.face(face));
  visit(slot(0, 1), ring.nextEdge(face));
  const Sides sides = ring.sides(face);
  if (!onLeft(sides)) {
    const int before = face == 0 ? k - 1 : face - 1;
    visit(slot(0, -1), ring.edge(before));
    visit(slot(1, -1), ring.face(before));
  }
  if (!onRight(sides)) {
    const int after = face + 1 == k ? 0 : face + 1;
    visit(slot(-1, 1), ring.face(after));
    visit(slot(-1, 0), ring.nextEdge(after));
  }
}

}  // namespace limitsurf
