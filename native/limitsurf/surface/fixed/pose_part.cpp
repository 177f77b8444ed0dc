// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/pose_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

void addPoints(const TileTable& table, TileRef ref, std::vector<int>& points,
               std::vector<int>& rings) {
  if (ref.kind == TileRef::kBSpline) {
    const BSplineTile& tile = table.bsplines[ref.index];
    points.insert(points.end(), tile.points.begin(), tile.points.end());
    return;
  }
  const RingTile& tile = table.ring_tiles[ref.index];
  const std::size_t outer = table.rings[tile.ring].basis->outerModes(tile.face).slots().size();
  points.insert(points.end(), tile.outer.begin(),
                tile.outer.begin() + static_cast<std::ptrdiff_t>(outer));
  if (rings.empty() || rings.back() != tile.ring) {  // tiles are grouped by ring
    rings.push_back(tile.ring);
    const std::vector<int>& of_ring = table.rings[tile.ring].points;
    points.insert(points.end(), of_ring.begin(), of_ring.end());
  }
}

}  // namespace

PosePart posePart(const TileTable& table, std::vector<TileRef> tiles) {
  PosePart part;
  if (tiles.empty()) {
    return part;
  }
  const auto key = [](TileRef tile) { return std::uint64_t{tile.kind} << 32 | tile.index; };
  std::sort(tiles.begin(), tiles.end(), [&](TileRef a, TileRef b) { return key(a) < key(b); });
  const auto end = std::unique(tiles.begin(), tiles.end(),
                               [&](TileRef a, TileRef b) { return key(a) == key(b); });
  std::vector<int> waiting;
  InterruptionStride stride;
  std::for_each(tiles.begin(), end, [&](TileRef tile) {
    stride.step();
    addPoints(table, tile, waiting, part.rings);
  });
  std::vector<bool> is_found(static_cast<std::size_t>(table.points.size()));
  while (!waiting.empty()) {
    stride.step();
    const int point = waiting.back();
    waiting.pop_back();
    if (point < table.points.cagePoints() || is_found[static_cast<std::size_t>(point)]) {
      continue;
    }
    is_found[static_cast<std::size_t>(point)] = true;
    part.points.push_back(point);
    const Span<int> sources = table.points.sources(point);
    waiting.insert(waiting.end(), sources.begin(), sources.end());
  }
  // A point's sources have smaller numbers.
  std::sort(part.points.begin(), part.points.end());
  return part;
}

}  // namespace limitsurf
