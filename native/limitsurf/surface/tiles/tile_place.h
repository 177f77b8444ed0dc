// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/surface/tile_evaluator.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// What a tile is a part of: a regular tile's strip, or a quarter of a ring tile after some steps.
struct TilePart {
  TileRef tile;
  int steps = 0;     ///< of a ring tile; >= 1
  int a = 0, b = 0;  ///< the quarter
  int strip = 0;     ///< of a regular tile
  int turns = 0;     ///< of the tile's frame against the Ptex face's
  int depth = 0;     ///< splits of the Ptex face on the way to the tile

  /// The same for all places in the same part, and for no others.
  std::uint64_t key() const {
    const std::uint64_t part = tile.kind == TileRef::kRing
                                   ? static_cast<std::uint64_t>(4 * steps + 2 * b + a)
                                   : static_cast<std::uint64_t>(strip);
    return (static_cast<std::uint64_t>(tile.kind) << 62) |
           (static_cast<std::uint64_t>(tile.index) << 32) | part;
  }
};

/// A location's part, and where in it the location lies.
struct Place {
  TilePart part;
  double u, v;              ///< in [0, 1], along the Ptex face's axes
  double u_scale, v_scale;  ///< of derivatives
  bool moved = false;
};

/// Finds the parts of tiles that locations lie in.
class PlaceFinder {
 public:
  PlaceFinder(const TileTable& table, const Pose& pose, int max_depth)
      : table_(table), evaluator_(table, pose), max_depth_(max_depth) {}

  Place operator()(const Location& at) const;

 private:
  void findQuarter(const TileLocation& local, Place& place) const;
  void findStrip(const TileLocation& local, Place& place) const;

  const TileTable& table_;
  const TileEvaluator evaluator_;
  const int max_depth_;
};

}  // namespace limitsurf
