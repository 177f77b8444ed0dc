// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "limitsurf/prefetch.h"
#include "limitsurf/sample/blue_noise/disc_grid.h"
#include "limitsurf/sample/blue_noise/near_discs.h"

namespace limitsurf {

/// Searches a grid that does not change meanwhile, for all discs near a position at once. Where all
/// discs are on one level it remembers those around the last positions, since one search after the
/// other is in the same cubes.
class DiscFinder {
 public:
  explicit DiscFinder(const DiscGrid& grid) : grid_(grid) {}

  /// Discs near the position: all that are in conflict with a disc of this radius there, and more.
  /// They are those of last() until the next search. The grid's cubes must not be sorted.
  const NearDiscs& near(const Vector3& position, double radius) {
    if (grid_.sides_.size() > 1) {
      own_.clear();
      grid_.any(position, std::min(kWider * radius, grid_.largest_), [&](int number) {
        own_.add(grid_.discs_[number], number);
        return false;
      });
      last_ = &own_;
      return own_;
    }
    const Place& place = placeAt(position);
    last_ = &place.near;
    return place.near;
  }
  /// Whether a disc of the grid has a rival: as DiscGrid::hasRival(), and faster where few discs
  /// are around it.
  bool hasRival(std::size_t number) {
    const NoiseDisc& own = grid_.disc(number);
    if (!grid_.isCrowded()) {
      return near(own.position, own.radius).conflict(own, static_cast<double>(number));
    }
    if (grid_.sides_.size() > 1) {
      return grid_.hasRival(number);
    }
    const Place& place = placeAt(own.position);
    return place.is_crowded ? grid_.hasRival(number)
                            : place.near.conflict(own, static_cast<double>(number));
  }
  /// Those that the last search has found: most of the discs near other positions as well, if these
  /// are close to that of the search.
  const NearDiscs& last() const { return *last_; }

  /// Has the processor read what searches at the first `count` of these places are going to need.
  void prepare(const PlaceBlock& places, std::size_t count) {
    if (grid_.sides_.size() > 1) {
      return;
    }
    const DiscGrid::Block* blocks[PlaceBlock::kCount] = {};
    Index low[PlaceBlock::kCount][3];
    bool is_new[PlaceBlock::kCount];
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3 position(places.position[0][i], places.position[1][i], places.position[2][i]);
      grid_.indexOf(position, 0, 0.5, low[i]);
      is_new[i] = !placeOf(low[i]).holds(low[i]);
      if (is_new[i]) {
        prefetch(grid_.table_[grid_.slot(0, low[i])]);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (is_new[i]) {
        blocks[i] = grid_.find(0, low[i]);
        if (blocks[i]) {
          prefetch(blocks[i]->first);
        }
      }
    }
  }

 private:
  using Index = DiscGrid::Index;

  /// The discs in the eight cubes from `low` on.
  struct Place {
    bool is_known = false;
    Index low[3];
    bool is_crowded;  ///< one of the cubes is sorted
    NearDiscs near;   ///< if not crowded; the list would be long

    bool holds(const Index at[3]) const { return is_known && std::equal(at, at + 3, low); }
  };
  static constexpr int kPlaces = 64;
  /// Where discs are on several levels, a search looks for discs around one of this many times the
  /// radius, so that last() has most of those that matter around it.
  static constexpr double kWider = 2;

  Place& placeOf(const Index low[3]) {
    return places_[(low[0] & 3) | (low[1] & 3) << 2 | (low[2] & 3) << 4];
  }

  Place& placeAt(const Vector3& position) {
    Index low[3];
    grid_.indexOf(position, 0, 0.5, low);
    Place& place = placeOf(low);
    if (!place.holds(low)) {
      gather(low, place);
    }
    return place;
  }

  void gather(const Index low[3], Place& place) {
    place.is_known = true;
    std::copy(low, low + 3, place.low);
    place.is_crowded = false;
    place.near.clear();
    found_.clear();
    // The cubes are in one block, or in a few.
    const DiscGrid::Block* block = nullptr;
    Index at[3], block_at[3] = {0, 0, 0};
    bool is_found = false;
    for (int i = 0; i < 8; ++i) {
      DiscGrid::cornerOf(low, i ^ i >> 1, at);  // neighbours one after the other
      Index own[3];
      for (int axis = 0; axis < 3; ++axis) {
        own[axis] = at[axis] >> DiscGrid::kBlockBits;
      }
      if (!is_found || !std::equal(own, own + 3, block_at)) {
        block = grid_.find(0, at);
        std::copy(own, own + 3, block_at);
        is_found = true;
      }
      if (block) {
        const int cube = DiscGrid::cubeOf(at);
        if (block->is_sorted >> cube & 1) {
          place.is_crowded = true;
          return;
        }
        const std::int32_t first = block->firstOf(cube);
        for (std::int32_t disc = first; disc >= 0; disc = grid_.next_[disc]) {
          prefetch(grid_.discs_[disc]);
          found_.push_back(disc);
        }
      }
    }
    for (const std::int32_t disc : found_) {
      place.near.add(grid_.discs_[disc], disc);
    }
  }

  const DiscGrid& grid_;
  Place places_[kPlaces];
  NearDiscs own_;
  std::vector<std::int32_t> found_;
  const NearDiscs* last_ = &own_;
};

}  // namespace limitsurf
