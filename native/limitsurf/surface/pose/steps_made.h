// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace limitsurf {

/// How many steps of each tile have been made, where any number of threads may find that they need
/// more. One of them claims the tile and makes them. Nobody waits for it: it might be in a process
/// from which this one was forked.
class StepsMade {
 public:
  static constexpr int kMostSteps = 127;

  explicit StepsMade(std::size_t tiles)
      : tiles_(tiles), states_(new std::atomic<std::uint8_t>[tiles]) {
    clear();
  }

  /// Nothing is made. No other thread may use the object meanwhile.
  void clear() {
    for (std::size_t i = 0; i < tiles_; ++i) {
      states_[i].store(0, std::memory_order_relaxed);
    }
  }

  /// Whether so many steps can be read, by this thread as well.
  bool has(int tile, int steps) const {
    return (states_[tile].load(std::memory_order_acquire) & ~kClaimed) >= steps;
  }

  static constexpr int kClaimedByOther = -1;
  /// Claims a tile and returns how many steps it has. The caller must put() it back.
  int claim(int tile) const {
    std::uint8_t state = states_[tile].load(std::memory_order_acquire);
    while (!(state & kClaimed)) {
      const auto claimed = static_cast<std::uint8_t>(state | kClaimed);
      if (states_[tile].compare_exchange_weak(state, claimed, std::memory_order_acquire)) {
        return state;
      }
    }
    return kClaimedByOther;
  }
  /// Ends a claim; now the tile has so many steps.
  void put(int tile, int steps) const {
    states_[tile].store(static_cast<std::uint8_t>(steps), std::memory_order_release);
  }

 private:
  static constexpr std::uint8_t kClaimed = 0x80;

  std::size_t tiles_;
  std::unique_ptr<std::atomic<std::uint8_t>[]> states_;
};

}  // namespace limitsurf
