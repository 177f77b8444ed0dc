// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/blue_noise/noise_disc.h"
#include "limitsurf/sample/blue_noise/noise_kernels.h"

namespace limitsurf {

/// Discs near a place, which are tested many at a time (NoiseKernels).
class NearDiscs {
 public:
  void clear() {
    size_ = 0;
    blocks_.clear();
  }
  void add(const NoiseDisc& disc, std::int32_t number) {
    const std::size_t place = size_ % DiscBlock::kCount;
    if (place == 0) {
      blocks_.reserve(kUsualBlocks);
      blocks_.push_back(emptyBlock());
    }
    DiscBlock& block = blocks_.back();
    for (int axis = 0; axis < 3; ++axis) {
      block.position[axis][place] = disc.position[axis];
      block.normal[axis][place] = disc.normal[axis];
    }
    block.radius[place] = disc.radius;
    block.rank[place] = disc.rank;
    block.number[place] = number;
    ++size_;
  }

  /// Whether any of them is in conflict with the disc `own`, sees it, and comes before it: has a
  /// lower rank, or the same rank and a lower number.
  bool conflict(const NoiseDisc& own, double number) const {
    return NoiseKernels::get().conflict(blocks_.data(), blocks_.size(), own, number);
  }
  /// A bit for each part that one of them covers.
  unsigned covered(const CellParts& parts) const {
    return NoiseKernels::get().covered(blocks_.data(), blocks_.size(), parts);
  }

  std::size_t size() const { return size_; }
  NoiseDisc operator[](std::size_t i) const {
    const DiscBlock& block = blocks_[i / DiscBlock::kCount];
    const std::size_t place = i % DiscBlock::kCount;
    const auto vector = [&](const double (&from)[3][DiscBlock::kCount]) {
      return Vector3(from[0][place], from[1][place], from[2][place]);
    };
    NoiseDisc disc;
    disc.position = vector(block.position);
    disc.normal = vector(block.normal);
    disc.radius = block.radius[place];
    disc.rank = block.rank[place];
    return disc;
  }

 private:
  static const DiscBlock& emptyBlock() {
    static const DiscBlock block = [] {
      DiscBlock empty = {};
      for (double (&coordinates)[DiscBlock::kCount] : empty.position) {
        for (double& coordinate : coordinates) {
          coordinate = kFarAway;
        }
      }
      return empty;
    }();
    return block;
  }
  /// Squares of distances from there are infinite, in the unit in which surfaces have a size of 1.
  static constexpr double kFarAway = 1e200;

  static constexpr std::size_t kUsualBlocks = 4;

  std::size_t size_ = 0;
  std::vector<DiscBlock> blocks_;
};

}  // namespace limitsurf
