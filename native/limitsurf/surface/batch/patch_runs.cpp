// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/patch_runs.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "limitsurf/prefetch.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {
namespace {

void copy(const Padded& from, double to[4]) { std::memcpy(to, from.data(), sizeof from); }

}  // namespace

PatchRun PatchRuns::onPatch(const TilePatch& patch, bool is_single) {
  PatchRun run;
  if (patch.tile.kind == TileRef::kBSpline) {
    setBSpline(patch, run);
  } else {
    setRing(patch, is_single, run);
  }
  run.turns = patch.turns;
  run.a = patch.a;
  run.b = patch.b;
  return run;
}

GridRun PatchRuns::onGrids(int tile, int steps, int turns, int depth) {
  const RingTile& ring_tile = table_.ring_tiles[tile];
  const Pose::Grid* const grids = pose_.grids(tile, steps, own_grids_);
  GridRun run;
  run.grids = numbersOf(grids->points);
  run.steps = steps;
  run.u_low = onRight(ring_tile.sides);
  run.v_low = onLeft(ring_tile.sides);
  run.turns = turns;
  copy(grids->limit(), run.anchor);
  run.depth_scale = powerOfTwo(depth);
  return run;
}

void PatchRuns::prefetchTile(TileRef tile) const {
  if (tile.kind == TileRef::kBSpline) {
    prefetch(table_.bsplines[tile.index]);
  } else if (tile.kind == TileRef::kRing) {
    const int index = static_cast<int>(tile.index);
    prefetch(table_.ring_tiles[index]);
    const Pose::Grid* const grids = pose_.keptGrids(index);
    prefetch(grids[0]);  // three quarters of the locations lie there
    if (pose_.gridSteps(table_.ring_tiles[index]) > 1) {
      prefetch(grids[1]);
    }
  } else if (tile.kind == TileRef::kSplit) {
    const TileRef child = table_.splits[tile.index][0];
    if (child.kind != TileRef::kSplit) {
      prefetchTile(child);
    }
  }
}

void PatchRuns::setBSpline(const TilePatch& patch, PatchRun& run) {
  const BSplineTile& tile = table_.bsplines[patch.tile.index];
  if (tile.fine) {
    for (int i = 0; i < 16; ++i) {
      copy(pose_.difference(tile.points[i], tile.points[5]), window_[i]);
    }
    run.points = window_;
  } else {
    run.points = numbersOf(&pose_.point(0));
    run.indices = tile.points.data();
  }
  run.u_low = tile.x_low;
  run.u_high = tile.x_high;
  run.v_low = tile.y_low;
  run.v_high = tile.y_high;
  copy(pose_.point(tile.points[5]), run.anchor);
  run.value_scale = 1;
  std::fill_n(run.offset, 4, 0);
  run.first_scale = powerOfTwo(patch.depth);
  run.second_scale = powerOfTwo(2 * patch.depth);
}

void PatchRuns::setRing(const TilePatch& patch, bool is_single, PatchRun& run) {
  const int index = static_cast<int>(patch.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Padded* grid;
  if (patch.steps <= pose_.gridSteps(tile)) {
    const Pose::Grid& kept = pose_.grids(index, patch.steps, own_grids_)[patch.steps - 1];
    grid = kept.points;
    copy(kept.limit(), run.anchor);
    run.value_scale = 1;
    std::fill_n(run.offset, 4, 0);
    run.first_scale = powerOfTwo(patch.steps + patch.depth);
    run.second_scale = powerOfTwo(2 * (patch.steps + patch.depth));
  } else {
    const Pose::RingPose& ring = pose_.ring(tile.ring);
    setDeep(patch, is_single);
    run.has_nets = TileEvaluator::needsNets(*table_.rings[tile.ring].basis, order_);
    grid = deep_;
    copy(ring.limit, run.anchor);
    copy(ring.constant(), run.offset);
    run.value_scale = std::ldexp(1., 1 - patch.steps);
    run.first_scale = powerOfTwo(1 + patch.depth);
    run.second_scale = powerOfTwo(patch.steps + 1 + 2 * patch.depth);
  }
  run.points = numbersOf(grid + patch.b * tile_grid::kSize + patch.a);
  run.stride = tile_grid::kSize;
  run.u_low = onRight(tile.sides) && patch.a == 0;
  run.v_low = onLeft(tile.sides) && patch.b == 0;
  run.u_high = run.v_high = false;
}

void PatchRuns::setDeep(const TilePatch& patch, bool is_single) {
  if (patch.tile.index == deep_tile_ && patch.steps == deep_steps_) {
    return;
  }
  const int index = static_cast<int>(patch.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Eigenbasis& basis = *table_.rings[tile.ring].basis;
  const Points& coefficients = pose_.ring(tile.ring).coefficients;
  const Pose::OuterPoints outer = pose_.outerPoints(index);
  deep_tile_ = patch.tile.index;
  deep_steps_ = patch.steps;
  if (!TileEvaluator::needsNets(basis, order_)) {
    basis.controlGrid(tile.face, patch.steps, tile.ring_steps, coefficients, outer.points, deep_);
    return;
  }
  using derivative_nets::Selection;
  basis.derivativeNets(tile.face, patch.steps, tile.ring_steps, coefficients, outer.points,
                       is_single ? Selection::window(patch.a, patch.b) : Selection::whole(), deep_);
  if (is_single) {
    deep_steps_ = 0;  // the other quarters are missing
  }
}

}  // namespace limitsurf
