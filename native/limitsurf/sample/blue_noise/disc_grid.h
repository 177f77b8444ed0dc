// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "limitsurf/random_bits.h"
#include "limitsurf/sample/blue_noise/noise_disc.h"
#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Discs in space that can be found by their position: a hashed grid of cubes for each power of two
/// of the radius (a hierarchical hash grid).
///
/// A disc is kept on the level of its radius. Around a position, eight cubes of each higher level
/// hold all larger discs that matter. Smaller discs, of which there may be any number, are found by
/// descending from eight cubes of the position's own level; a cube knows whether there is anything
/// below it. Cubes are kept in blocks, since one is rarely looked for alone.
class DiscGrid {
 public:
  /// All positions must lie in `box`, and all radii between `smallest` and `largest`.
  DiscGrid(const Box& box, double smallest, double largest) : origin_(box.low), largest_(largest) {
    sides_.push_back(2 * smallest);
    while (2 * largest > sides_.back()) {
      sides_.push_back(2 * sides_.back());
    }
    for (const double side : sides_) {
      inverse_sides_.push_back(1 / side);
    }
    clear();
  }

  /// The smallest radius for which the indices of all cubes in the box fit into 32 bits.
  static double smallestRadius(const Box& box) {
    return (box.high - box.low).maxCoeff() / (std::uint32_t{1} << 30);
  }

  std::size_t size() const { return discs_.size(); }
  /// Discs are numbered in the order in which they were added.
  const NoiseDisc& disc(std::size_t number) const { return discs_[number]; }

  void clear();
  void reserve(std::size_t discs) { discs_.reserve(discs); }
  /// Adds lists of discs, one after the other.
  void insert(const std::vector<Span<NoiseDisc>>& lists, int threads);
  /// All discs. The grid must not be used any more.
  std::vector<NoiseDisc> takeDiscs() { return std::move(discs_); }

  /// Calls visit(number) for each disc whose centre is closer to the position than the mean of both
  /// radii, until visit() returns true. Returns whether it did.
  template <typename Visit>
  bool any(const Vector3& position, double radius, const Visit& visit) const {
    return any(position, radius, visit, [](std::int32_t) { return false; });
  }

  /// Sorts the discs of each crowded cube, so that hasRival() looks at few of them. To be called
  /// once all discs are there.
  void sortCrowded(int threads);
  /// Whether any cube is sorted.
  bool isCrowded() const { return is_crowded_; }
  /// Whether another disc is in conflict with a disc, sees it, and comes before it: has a lower
  /// rank, or the same rank and a lower number.
  bool hasRival(std::size_t number) const;

 private:
  friend class DiscFinder;
  using Index = std::int32_t;

  /// Blocks have 2^kBlockBits cubes a side.
  static constexpr int kBlockBits = 2, kCubes = 1 << (3 * kBlockBits);
  struct alignas(64) Block {
    std::atomic<std::int32_t> first[kCubes];  // of each cube, the disc added last; -1 if none
    std::uint64_t has_below = 0;              // a bit for each cube
    std::uint64_t is_sorted = 0;              // likewise

    Block() {
      for (std::atomic<std::int32_t>& disc : first) {
        disc.store(-1, std::memory_order_relaxed);
      }
    }
    std::int32_t firstOf(int cube) const { return first[cube].load(std::memory_order_relaxed); }
  };
  /// A place of the table of blocks.
  struct Entry {
    Index at[3] = {0, 0, 0};
    std::int32_t level = 0;
    Block* block = nullptr;
  };
  static constexpr std::size_t kFewestEntries = 256, kDiscsPerTask = 4096;
  /// The sides of cubes are rounded; distances to them are enlarged by more than that.
  static constexpr double kSideRounding = 1e-9;
  /// A cube with more discs is crowded. On a smooth surface a cube has some ten candidates at most.
  /// Where sheets are stacked or faces are slivers, it may have any number, and a search that looks
  /// at all of them takes too long.
  static constexpr int kCrowd = 64;
  /// Every so many discs, sortCrowded() looks whether the cube of one is crowded.
  static constexpr std::size_t kProbes = 16;
  /// The number of blocks that one task sorts.
  static constexpr std::size_t kBlocksPerTask = 32;

  int levelOf(double radius) const {
    int level = 0;
    while (2 * radius > sides_[level]) {
      ++level;
    }
    return level;
  }

  /// The index of the cube that holds the position, moved down by the part `down` of a cube's side.
  void indexOf(const Vector3& position, int level, double down, Index at[3]) const {
    for (int i = 0; i < 3; ++i) {
      const double exact = (position[i] - origin_[i]) * inverse_sides_[level] - down;
      const Index index = static_cast<Index>(exact);
      at[i] = exact < index ? index - 1 : index;  // rounded down
    }
  }
  static int cubeOf(const Index at[3]) {
    constexpr Index kMask = (1 << kBlockBits) - 1;
    return (at[0] & kMask) | (at[1] & kMask) << kBlockBits | (at[2] & kMask) << (2 * kBlockBits);
  }

  /// Where the search for the block of a cube begins.
  std::size_t slot(int level, const Index at[3]) const {
    std::uint64_t bits = static_cast<std::uint64_t>(level);
    for (int i = 0; i < 3; ++i) {
      bits = bits * 0x9e3779b97f4a7c15u + static_cast<std::uint32_t>(at[i] >> kBlockBits);
    }
    return mixed(bits) & (table_.size() - 1);
  }
  static bool isSame(const Entry& entry, int level, const Index at[3]) {
    return entry.level == level && entry.at[0] == at[0] >> kBlockBits &&
           entry.at[1] == at[1] >> kBlockBits && entry.at[2] == at[2] >> kBlockBits;
  }
  /// The block of a cube, or none if all its cubes are empty.
  Block* find(int level, const Index at[3]) const {
    for (std::size_t i = slot(level, at);; i = (i + 1) & (table_.size() - 1)) {
      const Entry& entry = table_[i];
      if (!entry.block || isSame(entry, level, at)) {
        return entry.block;
      }
    }
  }
  Block& made(int level, const Index at[3]);
  void grow();
  /// Marks the cubes of higher levels around a disc.
  void markAbove(const NoiseDisc& disc, int level);

  /// The cubes around a position on its own level: bit i of `corner` adds 1 to the index of axis i.
  static void cornerOf(const Index low[3], int corner, Index at[3]) {
    for (int i = 0; i < 3; ++i) {
      at[i] = low[i] + (corner >> i & 1);
    }
  }

  /// As the public one. In sorted cubes the discs from the first one on for which isPast(number) is
  /// true are left out.
  template <typename Visit, typename IsPast>
  bool any(const Vector3& position, double radius, const Visit& visit, const IsPast& isPast) const;
  template <typename Visit, typename IsPast>
  bool anyIn(int level, const Index at[3], bool downwards, const Vector3& position, double radius,
             const Visit& visit, const IsPast& isPast) const;

  bool comesBefore(std::int32_t a, std::int32_t b) const {
    return discs_[a].rank != discs_[b].rank ? discs_[a].rank < discs_[b].rank : a < b;
  }
  /// Whether a list has more than kCrowd discs.
  bool isLong(std::int32_t first) const {
    int count = 0;
    for (std::int32_t i = first; i >= 0 && count <= kCrowd; i = next_[i]) {
      ++count;
    }
    return count > kCrowd;
  }
  /// Sorts the discs of the crowded cubes of a block by comesBefore().
  void sortCubes(Block& block);

  static double squaredDistance(const Vector3& a, const Vector3& b) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
  }

  Vector3 origin_;
  double largest_;                             // of the radii
  std::vector<double> sides_, inverse_sides_;  // the side of the cubes of each level
  std::vector<std::size_t> on_level_;          // the number of discs on each level
  std::vector<NoiseDisc> discs_;
  std::vector<std::int32_t> next_;  // for each disc the next one of the same cube, or -1
  std::deque<Block> blocks_;
  std::vector<Entry> table_;  // a hash table with open addressing
  bool is_crowded_ = false;
};

template <typename Visit, typename IsPast>
bool DiscGrid::any(const Vector3& position, double radius, const Visit& visit,
                   const IsPast& isPast) const {
  const int own = levelOf(radius);
  for (int level = own; level < static_cast<int>(sides_.size()); ++level) {
    if (on_level_[level] == 0 && !(level == own && level > 0)) {
      continue;
    }
    Index low[3], middle[3];
    indexOf(position, level, 0.5, low);
    indexOf(position, level, 0, middle);
    const int own_corner =
        (middle[0] - low[0]) | (middle[1] - low[1]) << 1 | (middle[2] - low[2]) << 2;
    for (int i = 0; i < 8; ++i) {
      // The position's own cube comes first, since a disc in it often ends the search.
      const int corner = i ^ own_corner;
      Index at[3];
      cornerOf(low, corner, at);
      if (anyIn(level, at, level == own, position, radius, visit, isPast)) {
        return true;
      }
    }
  }
  return false;
}

template <typename Visit, typename IsPast>
bool DiscGrid::anyIn(int level, const Index at[3], bool downwards, const Vector3& position,
                     double radius, const Visit& visit, const IsPast& isPast) const {
  const Block* block = find(level, at);
  if (!block) {
    return false;
  }
  const int cube = cubeOf(at);
  const bool is_sorted = block->is_sorted >> cube & 1;
  for (std::int32_t i = block->firstOf(cube); i >= 0 && !(is_sorted && isPast(i)); i = next_[i]) {
    const NoiseDisc& disc = discs_[i];
    const double reach = (disc.radius + radius) / 2;
    if (squaredDistance(position, disc.position) < reach * reach && visit(i)) {
      return true;
    }
  }
  if (!downwards || !(block->has_below >> cube & 1)) {
    return false;
  }
  const double side = sides_[level - 1];
  // The radius of a disc on the level below is at most half the side of that level's cubes.
  const double reach = (side / 2 + radius) / 2;
  for (int corner = 0; corner < 8; ++corner) {
    const Index child[3] = {2 * at[0] + (corner & 1), 2 * at[1] + (corner >> 1 & 1),
                            2 * at[2] + (corner >> 2)};
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      const double low = origin_[i] + child[i] * side - position[i];
      const double outside = std::max({low, -(low + side), 0.});
      squared += outside * outside;
    }
    if (squared <= reach * reach * (1 + kSideRounding) &&
        anyIn(level - 1, child, true, position, radius, visit, isPast)) {
      return true;
    }
  }
  return false;
}

}  // namespace limitsurf
