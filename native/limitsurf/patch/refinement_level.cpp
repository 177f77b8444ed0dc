// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/refinement_level.h"

namespace limitsurf {

QuadCorners cornersOf(RefinementLevel& level, int quad) {
  QuadCorners result;
  for (int c = 0; c < 4; ++c) {
    const int vertex = level.mesh.vertex({quad, c});
    if (level.cage) {
      if (!level.cage->onlyQuadsAround(vertex)) {
        result.is_tile = false;
        return result;
      }
      if (level.cage->regularVertex(vertex)) {
        result.diagonal[c] = level.cage->fan(vertex).closed;
        continue;
      }
    }
    switch (level.sectors.state(vertex)) {
      case Sectors::State::settled: {
        const Sector& sector = level.sectors.sector(level.sectors.sectorOf({quad, c}));
        result.diagonal[c] = sector.regular() && sector.ring.kind == RingKind::interior;
        if (!sector.regular()) {
          ++result.irregular;
          result.irregular_corner = c;
        }
        break;
      }
      case Sectors::State::regular:
      case Sectors::State::crease:
        result.diagonal[c] = true;
        break;
      default:
        result.is_tile = false;
        return result;
    }
  }
  if (level.has_sharpness) {
    for (int side = 0; side < 4; ++side) {
      if (isSemiSharp(level.mesh.sharpness({quad, side}))) {
        ++result.creases;
        result.crease_side = side;
      }
    }
  }
  result.is_tile = result.irregular + result.creases <= 1;
  return result;
}

}  // namespace limitsurf
