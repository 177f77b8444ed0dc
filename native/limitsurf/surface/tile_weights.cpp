// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tile_weights.h"

#include <algorithm>

#include "limitsurf/patch/single_crease.h"

namespace limitsurf {
namespace {

/// The weights across a crease along the low side of a tile, or along its high side. t is the
/// distance from the low side; `cut` says whether the side opposite to the crease has no points
/// beyond it.
CubicWeights acrossCrease(float sharpness, double t, bool high_side, bool cut) {
  CubicWeights w = SingleCrease(sharpness).weights(high_side ? 1 - t : t, cut);
  if (high_side) {
    std::reverse(w.value, w.value + 4);
    std::reverse(w.first, w.first + 3);
    std::reverse(w.second, w.second + 2);
  }
  return w;
}

}  // namespace

TileWeights::TileWeights(const BSplineTile& tile, double u_, double v_)
    : u(u_, tile.x_low, tile.x_high), v(v_, tile.y_low, tile.y_high) {
  if (tile.crease > 0) {
    switch (tile.crease_side) {
      case 0:
        v = acrossCrease(tile.crease, v_, false, tile.y_high);
        break;
      case 1:
        u = acrossCrease(tile.crease, u_, true, tile.x_low);
        break;
      case 2:
        v = acrossCrease(tile.crease, v_, true, tile.y_low);
        break;
      default:
        u = acrossCrease(tile.crease, u_, false, tile.x_high);
    }
  }
}

TileStrips::TileStrips(const BSplineTile& tile)
    : count(1), side_(tile.crease_side), borders_{0, 1, 1, 1} {
  static_assert(sizeof borders_ == (SingleCrease::kMostStrips + 1) * sizeof(double));
  if (tile.crease > 0) {
    count = SingleCrease(tile.crease).strips(borders_);
  }
}

TileStrips::Strip TileStrips::at(int i) const {
  const double near = borders_[i], far = borders_[i + 1];
  switch (side_) {
    case 0:
      return {0, 1, near, far};
    case 1:
      return {1 - far, 1 - near, 0, 1};
    case 2:
      return {0, 1, 1 - far, 1 - near};
    default:
      return {near, far, 0, 1};
  }
}

}  // namespace limitsurf
