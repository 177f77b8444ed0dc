// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/batch/patch_run.h"
#include "limitsurf/surface/pose/pose.h"

namespace limitsurf {

/// A bicubic patch of a tile: all of a regular tile, or what a quarter of a ring tile is after some
/// steps.
struct TilePatch {
  TileRef tile;
  int turns, depth;
  int steps, a, b;  ///< of the quarter; 0 on a regular tile
};

/// Finds the control points of patches: makes the runs for the kernels, but for the rows and the
/// limits of normals. A run on a patch is valid until the next one is made.
class PatchRuns {
 public:
  /// For derivatives up to `order`.
  PatchRuns(const TileTable& table, const Pose& pose, int order)
      : table_(table), pose_(pose), order_(order) {}

  /// If `is_single`, the run is for a single row.
  PatchRun onPatch(const TilePatch& patch, bool is_single);
  /// On the grids of a ring tile after its first steps, which are kept.
  GridRun onGrids(int tile, int steps, int turns, int depth);

  /// Has the processor fetch what most locations on a ring tile will read, or on the first child of
  /// a split tile.
  void prefetchTile(TileRef tile) const;

  bool hasCrease(TileRef tile) const { return table_.bsplines[tile.index].crease > 0; }

 private:
  void setBSpline(const TilePatch& patch, PatchRun& run);
  void setRing(const TilePatch& patch, bool is_single, PatchRun& run);
  /// Computes the points of a ring tile after more steps than are kept, or their nets: all of them,
  /// unless they are for a single row.
  void setDeep(const TilePatch& patch, bool is_single);

  const TileTable& table_;
  const Pose& pose_;
  const int order_;

  alignas(64) double window_[16][4];      // of a fine tile
  Padded deep_[derivative_nets::kCount];  // of the last ring tile below the grids that are kept
  std::uint32_t deep_tile_ = 0;
  int deep_steps_ = 0;
  Pose::OwnGrids own_grids_;
};

}  // namespace limitsurf
