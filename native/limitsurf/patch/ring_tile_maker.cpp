// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/ring_tile_maker.h"

#include <algorithm>
#include <numeric>

namespace limitsurf {

RingTile RingTileMaker::make(int level, FaceCorner at, const std::array<bool, 4>& diagonal) {
  RefinementLevel& here = *levels_[level];
  RingTile tile;
  tile.corner = at.corner;
  const RefinementLevel::RingAge age = ringOf(level, here.sectors.sectorOf(at));
  tile.ring = age.ring;
  tile.ring_steps = age.steps;
  tile.face = here.sectors.positionOf(at);
  tile.sides = table_.rings[tile.ring].basis->sides(tile.face);
  const Window window(here.mesh, at.face, at.corner, diagonal);
  const std::vector<int>& slots = table_.rings[tile.ring].basis->outerModes(tile.face).slots();
  tile.u_high = window.at(2, 0) < 0 && window.at(2, 1) < 0;
  tile.v_high = window.at(0, 2) < 0 && window.at(1, 2) < 0;
  tile.outer.fill(0);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    tile.outer[i] =
        outerPoint(here.mesh, window, tile_grid::xOf(slots[i]), tile_grid::yOf(slots[i]));
  }
  return tile;
}

/// A point of the window, continued linearly past the surface's boundary (Lacewell & Burley 2007,
/// figure 2), which the vertices there, being regular, allow.
int RingTileMaker::outerPoint(FaceMesh& mesh, const Window& window, int x, int y) {
  if (const int vertex = window.at(x, y); vertex >= 0) {
    return mesh.point(vertex);
  }
  const bool beyond_x = x == 2 && window.at(2, 0) < 0 && window.at(2, 1) < 0;
  const int inner =
      beyond_x ? outerPoint(mesh, window, x - 1, y) : outerPoint(mesh, window, x, y - 1);
  const int next =
      beyond_x ? outerPoint(mesh, window, x - 2, y) : outerPoint(mesh, window, x, y - 2);
  const auto [known, is_new] = reflections_.try_emplace({inner, next}, 0);
  if (is_new) {
    known->second = table_.points.addReflection(inner, next);
  }
  return known->second;
}

/// The ring of a sector. It is made at the coarsest level at which the vertex is settled and has
/// only quads around it.
RefinementLevel::RingAge RingTileMaker::ringOf(int level, int sector) {
  RefinementLevel& at = *levels_[level];
  at.rings.resize(at.sectors.sectorCount());
  if (at.rings[sector].ring >= 0) {
    return at.rings[sector];
  }
  RefinementLevel::RingAge age;
  const int vertex = at.mesh.vertex(at.sectors.sector(sector).first);
  const int above = at.refined ? at.refined->parentVertex(vertex) : -1;
  if (above >= 0 && levels_[level - 1]->onlyQuadsAround(above) &&
      levels_[level - 1]->sectors.state(above) == Sectors::State::settled) {
    const int which = sector - at.sectors.firstSector(vertex);
    age = ringOf(level - 1, levels_[level - 1]->sectors.firstSector(above) + which);
    ++age.steps;
  } else {
    age.ring = static_cast<int>(table_.rings.size());
    table_.rings.push_back(makeRing(at.mesh, at.sectors.sector(sector)));
  }
  at.rings[sector] = age;
  return age;
}

RingPoints RingTileMaker::makeRing(FaceMesh& mesh, const Sector& sector) {
  const Ring& ring = sector.ring;
  RingPoints result;
  std::shared_ptr<const Eigenbasis>& basis = bases_[ring];
  if (!basis) {
    basis = Eigenbasis::get(ring);
  }
  result.basis = basis;
  result.points.resize(ring.size());
  FaceCorner at = sector.first;
  result.points[0] = mesh.point(mesh.vertex(at));
  for (int j = 0; j < ring.faces; ++j) {
    result.points[ring.edge(j)] = mesh.point(mesh.vertexAfter(at, 1));
    result.points[ring.face(j)] = mesh.point(mesh.vertexAfter(at, 2));
    if (j + 1 < ring.faces) {
      at = mesh.turned(at);
    } else if (ring.edges() > ring.faces) {
      result.points[ring.edge(j + 1)] = mesh.point(mesh.vertexAfter(at, 3));
    }
  }
  if (ring.kind == RingKind::tip || ring.kind == RingKind::loop) {
    const CreaseEnds& ends = *mesh.creaseEnds(mesh.vertex(sector.first));
    if (ring.kind == RingKind::tip) {
      result.points[ring.creaseMean()] = table_.points.addMidpoint(ends[0], ends[1]);
    } else {
      result.points[ring.edge(ring.faces)] = ends[1];
    }
  }
  return result;
}

void groupByRing(TileTable& table) {
  std::vector<std::uint32_t> next(table.rings.size() + 1, 0);  // the place of a ring's next tile
  for (const RingTile& tile : table.ring_tiles) {
    ++next[tile.ring + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<RingTile> sorted(table.ring_tiles.size());
  std::vector<std::uint32_t> place(table.ring_tiles.size());
  for (std::size_t old = 0; old < place.size(); ++old) {
    place[old] = next[table.ring_tiles[old].ring]++;
    sorted[place[old]] = table.ring_tiles[old];
  }
  table.ring_tiles = std::move(sorted);
  const auto renumber = [&](TileRef& ref) {
    if (ref.kind == TileRef::kRing) {
      ref.index = place[ref.index];
    }
  };
  std::for_each(table.faces.begin(), table.faces.end(), renumber);
  for (auto& children : table.splits) {
    std::for_each(children.begin(), children.end(), renumber);
  }
}

}  // namespace limitsurf
