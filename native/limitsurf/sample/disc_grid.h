// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "limitsurf/random_bits.h"
#include "limitsurf/surface/surface_patches.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Discs in space that can be found by their position: a hashed grid of cubes for each power of two
/// of the radius (a hierarchical hash grid).
///
/// A disc is kept on the level of its radius. Around a position, eight cubes of each higher level
/// hold all larger discs that matter. Smaller discs, of which there may be any number, are found by
/// descending from eight cubes of the position's own level; a cube knows whether there is anything
/// below it.
class DiscGrid {
 public:
  class Finder;

  /// All positions must lie in `box`, and all radii between `smallest` and `largest`.
  DiscGrid(const Box& box, double smallest, double largest) : origin_(box.low) {
    sides_.push_back(2 * smallest);
    while (2 * largest > sides_.back()) {
      sides_.push_back(2 * sides_.back());
    }
    clear();
  }

  /// The smallest radius for which the indices of all cubes in the box fit into 32 bits.
  static double smallestRadius(const Box& box) {
    return (box.high - box.low).maxCoeff() / (std::uint32_t{1} << 30);
  }

  std::size_t size() const { return discs_.size(); }

  void clear() {
    discs_.clear();
    on_level_.assign(sides_.size(), 0);
    // The table will probably hold as many cubes as it held last.
    std::size_t cubes = kFewestCubes;
    while (cubes < 2 * used_) {
      cubes *= 2;
    }
    cubes_.assign(cubes, {});
    used_ = 0;
  }

  /// Adds a disc. Discs are numbered in the order in which they are added.
  void insert(const Vector3& position, double radius) {
    const int level = levelOf(radius);
    Index at[3];
    indexOf(position, level, 0, at);
    Cube& cube = made(level, at);
    discs_.push_back({{position[0], position[1], position[2]}, radius, cube.first});
    cube.first = static_cast<std::int32_t>(discs_.size() - 1);
    ++on_level_[level];
    for (int above = level + 1; above < static_cast<int>(sides_.size()); ++above) {
      indexOf(position, above, 0, at);
      Cube& parent = made(above, at);
      if (parent.has_below) {
        break;
      }
      parent.has_below = true;
    }
  }

  /// Calls visit(number) for each disc whose centre is closer to the position than the mean of both
  /// radii, until visit() returns true. Returns whether it did.
  template <typename Visit>
  bool any(const Vector3& position, double radius, const Visit& visit) const {
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
        if (anyIn(level, at, level == own, position, radius, visit)) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  using Index = std::int32_t;

  struct Disc {
    double position[3];
    double radius;
    std::int32_t next;  // the next disc of the same cube, or -1
  };
  struct Cube {
    Index at[3] = {0, 0, 0};
    std::int8_t level = -1;  // -1: this place of the table is free
    bool has_below = false;
    std::int32_t first = -1;  // the disc added last
  };
  static constexpr std::size_t kFewestCubes = 1024;
  /// Blocks of 2^kBlockBits cubes a side are hashed as a whole.
  static constexpr int kBlockBits = 2;
  /// The sides of cubes are rounded; distances to them are enlarged by more than that.
  static constexpr double kSideRounding = 1e-9;

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
      at[i] = static_cast<Index>(std::floor((position[i] - origin_[i]) / sides_[level] - down));
    }
  }

  /// Where the search for a cube begins: neighbouring cubes are close to each other in the table,
  /// since one is rarely looked for alone.
  std::size_t slot(int level, const Index at[3]) const {
    std::uint32_t block[3], within = 0;
    for (int i = 0; i < 3; ++i) {
      block[i] = static_cast<std::uint32_t>(at[i]) >> kBlockBits;
      within |= (static_cast<std::uint32_t>(at[i]) & ((1u << kBlockBits) - 1)) << (kBlockBits * i);
    }
    const std::uint64_t bits =
        (static_cast<std::uint64_t>(block[0]) | static_cast<std::uint64_t>(block[1]) << 32) ^
        (static_cast<std::uint64_t>(block[2]) * 0x9e3779b97f4a7c15u +
         static_cast<std::uint64_t>(level));
    return (mixed(bits) << (3 * kBlockBits) | within) & (cubes_.size() - 1);
  }
  static bool isSame(const Cube& cube, int level, const Index at[3]) {
    return cube.level == level && cube.at[0] == at[0] && cube.at[1] == at[1] && cube.at[2] == at[2];
  }

  /// The cubes around a position on its own level: bit i of `corner` adds 1 to the index of axis i.
  static void cornerOf(const Index low[3], int corner, Index at[3]) {
    for (int i = 0; i < 3; ++i) {
      at[i] = low[i] + (corner >> i & 1);
    }
  }

  const Cube* find(int level, const Index at[3]) const {
    for (std::size_t i = slot(level, at);; i = (i + 1) & (cubes_.size() - 1)) {
      const Cube& cube = cubes_[i];
      if (cube.level < 0) {
        return nullptr;
      }
      if (isSame(cube, level, at)) {
        return &cube;
      }
    }
  }

  Cube& made(int level, const Index at[3]) {
    if (2 * used_ >= cubes_.size()) {
      grow();
    }
    for (std::size_t i = slot(level, at);; i = (i + 1) & (cubes_.size() - 1)) {
      Cube& cube = cubes_[i];
      if (cube.level < 0) {
        ++used_;
        std::copy(at, at + 3, cube.at);
        cube.level = static_cast<std::int8_t>(level);
        return cube;
      }
      if (isSame(cube, level, at)) {
        return cube;
      }
    }
  }

  void grow() {
    std::vector<Cube> old(2 * cubes_.size());
    old.swap(cubes_);
    for (const Cube& cube : old) {
      if (cube.level >= 0) {
        std::size_t i = slot(cube.level, cube.at);
        while (cubes_[i].level >= 0) {
          i = (i + 1) & (cubes_.size() - 1);
        }
        cubes_[i] = cube;
      }
    }
  }

  template <typename Visit>
  bool anyIn(int level, const Index at[3], bool downwards, const Vector3& position, double radius,
             const Visit& visit) const {
    const Cube* cube = find(level, at);
    if (!cube) {
      return false;
    }
    for (std::int32_t i = cube->first; i >= 0; i = discs_[i].next) {
      const Disc& disc = discs_[i];
      const double reach = (disc.radius + radius) / 2;
      if (squaredDistance(position, disc.position) < reach * reach && visit(i)) {
        return true;
      }
    }
    if (!downwards || !cube->has_below) {
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
          anyIn(level - 1, child, true, position, radius, visit)) {
        return true;
      }
    }
    return false;
  }

  static double squaredDistance(const Vector3& a, const double b[3]) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
  }

  Vector3 origin_;
  std::vector<double> sides_;          // the side of the cubes of each level
  std::vector<std::size_t> on_level_;  // the number of discs on each level
  std::vector<Disc> discs_;
  std::vector<Cube> cubes_;  // a hash table with open addressing
  std::size_t used_ = 0;
};

/// Searches a grid that does not change meanwhile. Where all discs are on one level it remembers
/// those around the last positions, since one search after the other is in the same cubes.
class DiscGrid::Finder {
 public:
  explicit Finder(const DiscGrid& grid) : grid_(grid) {}

  /// What DiscGrid::any() does, in another order.
  template <typename Visit>
  bool any(const Vector3& position, double radius, const Visit& visit) {
    if (grid_.sides_.size() > 1) {
      return grid_.any(position, radius, visit);
    }
    search(position);
    return anyIn(*last_, position, radius, visit);
  }

  /// The same, but where all discs are on one level it visits only those that the last search has
  /// met, in the cubes around the position that was searched then: most of them, if both are close
  /// to each other.
  template <typename Visit>
  bool anyAgain(const Vector3& position, double radius, const Visit& visit) const {
    return grid_.sides_.size() > 1 ? grid_.any(position, radius, visit)
                                   : anyIn(*last_, position, radius, visit);
  }

  /// Prepares anyAgain().
  void search(const Vector3& position) {
    Index low[3];
    grid_.indexOf(position, 0, 0.5, low);
    Place& place = places_[(low[0] & 3) | (low[1] & 3) << 2 | (low[2] & 3) << 4];
    if (!place.is_known || !std::equal(low, low + 3, place.low)) {
      gather(low, place);
    }
    last_ = &place;
  }

 private:
  struct Near {
    Disc disc;
    std::int32_t number;
  };
  /// The discs in the eight cubes from `low` on.
  struct Place {
    bool is_known = false;
    Index low[3];
    std::vector<Near> near;
  };
  static constexpr int kPlaces = 64;

  void gather(const Index low[3], Place& place) const {
    place.is_known = true;
    std::copy(low, low + 3, place.low);
    place.near.clear();
    for (int corner = 0; corner < 8; ++corner) {
      Index at[3];
      cornerOf(low, corner, at);
      if (const Cube* cube = grid_.find(0, at)) {
        for (std::int32_t i = cube->first; i >= 0; i = grid_.discs_[i].next) {
          place.near.push_back({grid_.discs_[i], i});
        }
      }
    }
  }

  template <typename Visit>
  static bool anyIn(const Place& place, const Vector3& position, double radius,
                    const Visit& visit) {
    for (const Near& near : place.near) {
      const double reach = (near.disc.radius + radius) / 2;
      if (squaredDistance(position, near.disc.position) < reach * reach && visit(near.number)) {
        return true;
      }
    }
    return false;
  }

  const DiscGrid& grid_;
  Place places_[kPlaces];
  const Place* last_ = places_;
};

}  // namespace limitsurf
