// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/blue_noise/disc_grid.h"

#include <utility>

#include "limitsurf/interruptible_sort.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/parallel.h"

namespace limitsurf {

void DiscGrid::clear() {
  discs_.clear();
  next_.clear();
  on_level_.assign(sides_.size(), 0);
  blocks_.clear();
  table_.assign(kFewestEntries, {});
  is_crowded_ = false;
}

void DiscGrid::insert(const std::vector<Span<NoiseDisc>>& lists, int threads) {
  std::vector<std::size_t> begins = {discs_.size()};
  for (const Span<NoiseDisc>& list : lists) {
    begins.push_back(begins.back() + list.size());
  }
  const std::size_t before = begins.front(), after = begins.back();
  discs_.resize(after);
  next_.resize(after);
  std::vector<Block*> blocks(after - before);
  parallelFor(lists.size(), 1, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t list = first; list < last; ++list) {
      std::copy(lists[list].begin(), lists[list].end(), discs_.begin() + begins[list]);
      for (std::size_t i = begins[list]; i < begins[list + 1]; ++i) {
        const int level = levelOf(discs_[i].radius);
        Index at[3];
        indexOf(discs_[i].position, level, 0, at);
        blocks[i - before] = find(level, at);
      }
    }
  });
  // Few discs need new blocks.
  for (std::size_t i = before; i < after; ++i) {
    const int level = levelOf(discs_[i].radius);
    if (!blocks[i - before]) {
      Index at[3];
      indexOf(discs_[i].position, level, 0, at);
      blocks[i - before] = &made(level, at);
    }
    ++on_level_[level];
    if (sides_.size() > 1) {
      markAbove(discs_[i], level);
    }
  }
  parallelFor(after - before, kDiscsPerTask, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = before + first; i < before + last; ++i) {
      Index at[3];
      indexOf(discs_[i].position, levelOf(discs_[i].radius), 0, at);
      next_[i] = blocks[i - before]->first[cubeOf(at)].exchange(static_cast<std::int32_t>(i),
                                                                std::memory_order_relaxed);
    }
  });
}

void DiscGrid::sortCrowded(int threads) {
  InterruptionStride stride;
  for (std::size_t i = 0; i < discs_.size() && !is_crowded_; i += kProbes) {
    stride.step();
    is_crowded_ = isLong(static_cast<std::int32_t>(i));
  }
  if (is_crowded_) {
    parallelFor(blocks_.size(), kBlocksPerTask, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        sortCubes(blocks_[i]);
      }
    });
  }
}

void DiscGrid::sortCubes(Block& block) {
  std::vector<std::pair<double, std::int32_t>> order;  // as comesBefore()
  for (int cube = 0; cube < kCubes; ++cube) {
    if (!isLong(block.firstOf(cube))) {
      continue;
    }
    order.clear();
    for (std::int32_t i = block.firstOf(cube); i >= 0; i = next_[i]) {
      order.emplace_back(discs_[i].rank, i);
    }
    sortInterruptibly(order.begin(), order.end());
    std::int32_t after = -1;
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
      next_[i->second] = after;
      after = i->second;
    }
    block.first[cube].store(after, std::memory_order_relaxed);
    block.is_sorted |= std::uint64_t{1} << cube;
  }
}

bool DiscGrid::hasRival(std::size_t number) const {
  const NoiseDisc& own = discs_[number];
  const auto isPast = [&](std::int32_t other) {
    return !comesBefore(other, static_cast<std::int32_t>(number));
  };
  const auto isRival = [&](std::int32_t other) {
    return !isPast(other) && seeEachOther(discs_[other].normal, own.normal);
  };
  return any(own.position, own.radius, isRival, isPast);
}

void DiscGrid::markAbove(const NoiseDisc& disc, int level) {
  for (int above = level + 1; above < static_cast<int>(sides_.size()); ++above) {
    Index at[3];
    indexOf(disc.position, above, 0, at);
    Block& parent = made(above, at);
    const std::uint64_t bit = std::uint64_t{1} << cubeOf(at);
    if (parent.has_below & bit) {
      break;
    }
    parent.has_below |= bit;
  }
}

DiscGrid::Block& DiscGrid::made(int level, const Index at[3]) {
  if (2 * blocks_.size() >= table_.size()) {
    grow();
  }
  for (std::size_t i = slot(level, at);; i = (i + 1) & (table_.size() - 1)) {
    Entry& entry = table_[i];
    if (!entry.block) {
      blocks_.emplace_back();
      entry = {
          {at[0] >> kBlockBits, at[1] >> kBlockBits, at[2] >> kBlockBits}, level, &blocks_.back()};
      return blocks_.back();
    }
    if (isSame(entry, level, at)) {
      return *entry.block;
    }
  }
}

void DiscGrid::grow() {
  std::vector<Entry> old(2 * table_.size());
  old.swap(table_);
  for (const Entry& entry : old) {
    if (entry.block) {
      const Index at[3] = {entry.at[0] << kBlockBits, entry.at[1] << kBlockBits,
                           entry.at[2] << kBlockBits};
      std::size_t i = slot(entry.level, at);
      while (table_[i].block) {
        i = (i + 1) & (table_.size() - 1);
      }
      table_[i] = entry;
    }
  }
}

}  // namespace limitsurf
