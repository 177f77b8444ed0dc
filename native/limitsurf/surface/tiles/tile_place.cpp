// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/tile_place.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/tile_weights.h"

namespace limitsurf {

Place PlaceFinder::operator()(const Location& at) const {
  const TileLocation local = evaluator_.locate(at);
  Place place;
  place.part.tile = local.tile;
  place.part.turns = local.turns;
  place.part.depth = local.depth;
  if (local.tile.kind == TileRef::kRing) {
    findQuarter(local, place);
  } else {
    findStrip(local, place);
  }
  turnParameters((4 - local.turns) % 4, place.u, place.v);
  if (local.turns % 2 == 1) {
    std::swap(place.u_scale, place.v_scale);
  }
  return place;
}

void PlaceFinder::findQuarter(const TileLocation& local, Place& place) const {
  const int most_steps = std::max(1, max_depth_ - local.depth);
  double u = local.u, v = local.v;
  const double larger = std::max(u, v), least = std::ldexp(1., -most_steps);
  if (larger < least) {
    place.moved = true;
    u = larger > 0 ? std::min(1., u / larger) * least : least;
    v = larger > 0 ? std::min(1., v / larger) * least : least;
  }
  const Quarter quarter(u, v);
  place.part.steps = quarter.steps;
  place.part.a = quarter.a;
  place.part.b = quarter.b;
  place.u = quarter.u;
  place.v = quarter.v;
  place.u_scale = place.v_scale = std::ldexp(1., local.depth + quarter.steps);
}

void PlaceFinder::findStrip(const TileLocation& local, Place& place) const {
  const TileStrips strips(table_.bsplines[local.tile.index]);
  int i = 0;
  TileStrips::Strip strip = strips.at(0);
  const auto holds = [&] {
    return local.u >= strip.u0 && local.u <= strip.u1 && local.v >= strip.v0 && local.v <= strip.v1;
  };
  while (!holds() && i + 1 < strips.count) {
    strip = strips.at(++i);
  }
  place.part.strip = i;
  place.u = (local.u - strip.u0) / (strip.u1 - strip.u0);
  place.v = (local.v - strip.v0) / (strip.v1 - strip.v0);
  place.u_scale = std::ldexp(1., local.depth) / (strip.u1 - strip.u0);
  place.v_scale = std::ldexp(1., local.depth) / (strip.v1 - strip.v0);
}

}  // namespace limitsurf
