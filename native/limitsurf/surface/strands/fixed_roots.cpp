// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/fixed_roots.h"

#include <utility>

namespace limitsurf {
namespace {

/// The numbers of those places for which is(place).
template <typename Is>
std::vector<std::size_t> numbersOf(const std::vector<TileLocation>& places, const Is& is) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is(places[i])) {
      numbers.push_back(i);
    }
  }
  return numbers;
}

}  // namespace

FixedRoots::FixedRoots(std::shared_ptr<const TiledSurface> tiles, std::vector<TileLocation> places,
                       int threads)
    : tiles_(std::move(tiles)),
      places_(std::move(places)),
      planned_(numbersOf(places_, [](const TileLocation& place) { return !isSpecial(place); })),
      special_(numbersOf(places_, isSpecial)),
      plan_(
          tiles_, planned_.size(), [this](std::size_t row) { return places_[planned_[row]]; }, 1,
          threads),
      part_(partOf(special_)) {}

bool FixedRoots::isFaster(const TileTable& table, const TileLocation& place) {
  return !isSpecial(place) && !FixedRows::isSingle(table, place) &&
         !FixedRows::isOnLargeRing(table, place);
}

PosePart FixedRoots::partOf(const Numbers& some) const {
  std::vector<TileRef> tiles;
  for (const std::size_t i : some) {
    tiles.push_back(places_[i].tile);
  }
  return posePart(tiles_->table, std::move(tiles));
}

}  // namespace limitsurf
