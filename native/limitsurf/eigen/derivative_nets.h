// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "limitsurf/eigen/tile_grid.h"

namespace limitsurf {

/// The control points of a face's grid with their differences: derivatives of the bicubic patches
/// are B-splines of lower degree on these (evaluateNets()).
///
/// Deep in a ring's face the points are almost a linear function of their place, so that second
/// differences of points that have been rounded have no digits left. Here each mode's differences
/// are formed first, and then added up.
///
/// There are six nets of 25 numbers each, in rows of five as the grid: the points, the differences
/// along u and along v, and the differences of those. Where a difference would reach beyond its
/// row, what stands there is never used.
namespace derivative_nets {

enum Net { kPoints, kDu, kDv, kDuu, kDuv, kDvv, kNets };
constexpr int kCount = kNets * tile_grid::kSlots;
constexpr int at(Net net, int slot) { return net * tile_grid::kSlots + slot; }

/// The nets of a mode, from its grid.
inline void form(const double grid[tile_grid::kSlots], double nets[kCount]) {
  constexpr int kSlots = tile_grid::kSlots, kSize = tile_grid::kSize;
  for (int i = 0; i < kSlots; ++i) {
    nets[i] = grid[i];
  }
  const auto subtract = [&](Net to, Net from, int step) {
    double* const out = nets + at(to, 0);
    const double* const in = nets + at(from, 0);
    for (int i = 0; i < kSlots - step; ++i) {
      out[i] = in[i + step] - in[i];
    }
    for (int i = kSlots - step; i < kSlots; ++i) {
      out[i] = 0;
    }
  };
  subtract(kDu, kPoints, 1);
  subtract(kDv, kPoints, kSize);
  subtract(kDuu, kDu, 1);
  subtract(kDuv, kDu, kSize);
  subtract(kDvv, kDv, kSize);
}

/// Which of the numbers are used on a window of 4 x 4 points, or on the whole grid.
class Selection {
 public:
  /// That of the quarter (a, b) of the face.
  static const Selection& window(int a, int b) {
    static const std::array<Selection, 4> windows = {Selection(0, 0, 4), Selection(1, 0, 4),
                                                     Selection(0, 1, 4), Selection(1, 1, 4)};
    return windows[static_cast<std::size_t>(a + 2 * b)];
  }
  static const Selection& whole() {
    static const Selection all(0, 0, tile_grid::kSize);
    return all;
  }

  const int* begin() const { return numbers_.data(); }
  const int* end() const { return numbers_.data() + count_; }

 private:
  Selection(int x0, int y0, int size) {
    constexpr int kShorterX[kNets] = {0, 1, 0, 2, 1, 0}, kShorterY[kNets] = {0, 0, 1, 0, 1, 2};
    for (int net = 0; net < kNets; ++net) {
      for (int y = y0; y < y0 + size - kShorterY[net]; ++y) {
        for (int x = x0; x < x0 + size - kShorterX[net]; ++x) {
          numbers_[static_cast<std::size_t>(count_++)] =
              at(static_cast<Net>(net), y * tile_grid::kSize + x);
        }
      }
    }
  }

  std::array<int, kCount> numbers_{};
  int count_ = 0;
};

}  // namespace derivative_nets
}  // namespace limitsurf
