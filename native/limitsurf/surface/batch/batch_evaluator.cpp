// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/batch_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limitsurf/error.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_approach.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

static_assert(sizeof(Padded) == 4 * sizeof(double));
const double (*numbersOf(const Padded* points))[4] {
  return reinterpret_cast<const double (*)[4]>(points);
}

void copy(const Padded& from, double to[3]) {
  to[0] = from[0];
  to[1] = from[1];
  to[2] = from[2];
}

}  // namespace

template <typename Real>
BatchEvaluator<Real>::BatchEvaluator(const TileTable& table, const Pose& pose, int order,
                                     const PatchResults<Real>& results)
    : table_(table),
      pose_(pose),
      kernels_(PatchKernels::get()),
      kernel_(kernels_.evaluate<Real>(order)),
      order_(order),
      results_(results),
      alone_(table, pose) {}

template <typename Real>
void BatchEvaluator<Real>::evaluate(const LocationBatch& at, const RowOrder& order,
                                    std::size_t begin, std::size_t end) {
  double u[kMostRows], v[kMostRows];
  std::size_t rows[kMostRows];
  while (begin < end) {
    const int face = at[order[begin]].face;
    const std::size_t stop = std::min<std::size_t>(end, begin + kMostRows);
    unsigned count = 0;
    bool good = true;
    do {
      const std::size_t row = order[begin];
      const Location location = at[row];
      if (location.face != face) {
        break;
      }
      good &= (location.u >= 0) & (location.u <= 1) & (location.v >= 0) & (location.v <= 1);
      u[count] = location.u;
      v[count] = location.v;
      rows[count] = row;
      ++count;
    } while (++begin < stop);
    if (!good || static_cast<std::size_t>(face) >= table_.faces.size() ||
        table_.faces[face].kind == TileRef::kNone) {
      throw LocationError("the locations were changed while they were evaluated");
    }
    evaluateTile(table_.faces[face], 0, 0, {u, v, rows, count});
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateTile(TileRef tile, int turns, int depth, const Rows& rows) {
  constexpr unsigned kFewestRows = 3;  // fewer are located faster one by one
  if (tile.kind == TileRef::kBSpline && !hasCrease(tile)) {
    evaluatePatch({tile, turns & 3, depth, 0, 0, 0}, rows.u, rows.v, rows.rows, rows.count);
  } else if (tile.kind == TileRef::kBSpline || rows.count < kFewestRows) {
    for (unsigned i = 0; i < rows.count; ++i) {
      evaluateOne(alone_.locateBelow({tile, rows.u[i], rows.v[i], turns, depth}), rows.rows[i]);
    }
  } else if (tile.kind == TileRef::kSplit) {
    evaluateSplit(tile, turns, depth, rows);
  } else {
    evaluateRingTile(tile, turns, depth, rows);
  }
}

template <typename Real>
typename BatchEvaluator<Real>::Level& BatchEvaluator<Real>::level(int depth, unsigned rows) {
  while (static_cast<int>(levels_.size()) <= depth) {
    levels_.emplace_back();
  }
  Level& level = levels_[depth];
  if (level.part.size() < rows) {
    level.u.resize(rows);
    level.v.resize(rows);
    level.rows.resize(rows);
    level.part.resize(rows);
  }
  return level;
}

template <typename Real>
void BatchEvaluator<Real>::evaluateSplit(TileRef tile, int turns, int depth, const Rows& rows) {
  Level& parts = level(depth, rows.count);
  unsigned count[4] = {};
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned right = rows.u[i] >= 0.5, top = rows.v[i] >= 0.5;
    parts.part[i] = static_cast<std::uint8_t>(right ^ (3 * top));  // anticlockwise
    ++count[parts.part[i]];
  }
  unsigned end[4] = {0, count[0], count[0] + count[1], count[0] + count[1] + count[2]};
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned to = end[parts.part[i]]++;
    parts.u[to] = rows.u[i];
    parts.v[to] = rows.v[i];
    parts.rows[to] = rows.rows[i];
  }
  for (int child = 0; child < 4; ++child) {
    const unsigned first = end[child] - count[child];
    double *const u = &parts.u[first], *const v = &parts.v[first];
    for (unsigned i = 0; i < count[child]; ++i) {
      turnParameters(child, u[i], v[i]);
      u[i] *= 2;
      v[i] *= 2;
    }
    if (count[child] > 0) {
      evaluateTile(table_.splits[tile.index][child], turns + child, depth + 1,
                   {u, v, &parts.rows[first], count[child]});
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateRingTile(TileRef tile, int turns, int depth, const Rows& rows) {
  const RingTile& ring_tile = table_.ring_tiles[tile.index];
  const int corner = ring_tile.corner;
  const bool needs_nets = TileEvaluator::needsNets(*table_.rings[ring_tile.ring].basis, order_);
  turns = (turns + corner) & 3;
  // Parts are numbered 4 steps + a + 2 b. Rows that are evaluated one by one belong to part 0.
  constexpr unsigned kParts = 4 * (kMostSteps + 1);
  static_assert(kParts <= 256);
  Level& parts = level(depth, rows.count);
  unsigned begin[kParts] = {};
  int deepest = 0;
  for (unsigned i = 0; i < rows.count; ++i) {
    turnParameters(corner, rows.u[i], rows.v[i]);
    const double larger = std::max(rows.u[i], rows.v[i]);
    const int steps = Quarter::stepsTo(larger);
    const double edge = powerOfTwo(-steps);
    const int a = rows.u[i] >= edge ? 1 : 0, b = rows.v[i] >= edge ? 2 : 0;
    const bool on_spoke = std::min(rows.u[i], rows.v[i]) == 0;
    const int part = steps <= kMostSteps && !(needs_nets && on_spoke) ? 4 * steps + a + b : 0;
    parts.part[i] = static_cast<std::uint8_t>(part);
    deepest = std::max(deepest, part);
    ++begin[part];
  }
  const unsigned last = static_cast<unsigned>(deepest);
  unsigned next = 0;
  for (unsigned part = 0; part <= last; ++part) {
    next += std::exchange(begin[part], next);
  }
  for (unsigned i = 0; i < rows.count; ++i) {
    const unsigned to = begin[parts.part[i]]++;
    parts.u[to] = rows.u[i];
    parts.v[to] = rows.v[i];
    parts.rows[to] = rows.rows[i];
  }
  for (unsigned i = 0; i < begin[0]; ++i) {
    evaluateOne({tile, parts.u[i], parts.v[i], turns, depth}, parts.rows[i]);
  }
  for (unsigned part = 4, first = begin[0]; part <= last; first = begin[part++]) {
    const unsigned count = begin[part] - first;
    if (count == 0) {
      continue;
    }
    const Patch patch{tile,
                      turns,
                      depth,
                      static_cast<int>(part / 4),
                      static_cast<int>(part & 1),
                      static_cast<int>(part >> 1 & 1)};
    double *const u = &parts.u[first], *const v = &parts.v[first];
    const double scale = powerOfTwo(patch.steps);
    for (unsigned i = 0; i < count; ++i) {
      u[i] = u[i] * scale - patch.a;
      v[i] = v[i] * scale - patch.b;
    }
    evaluatePatch(patch, u, v, &parts.rows[first], count);
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateOne(const TileLocation& place, std::size_t row) {
  if (place.tile.kind == TileRef::kBSpline) {
    if (!hasCrease(place.tile)) {
      evaluatePatch({place.tile, place.turns, place.depth, 0, 0, 0}, &place.u, &place.v, &row, 1);
      return;
    }
  } else if (!place.atVertex()) {
    const Quarter quarter(place.u, place.v);
    const RingTile& tile = table_.ring_tiles[place.tile.index];
    const Eigenbasis& basis = *table_.rings[tile.ring].basis;
    if (quarter.steps <= pose_.gridSteps(tile) ||
        (quarter.steps <= kMostSteps &&
         !TileEvaluator::takesModes(basis, order_, place.u, place.v))) {
      evaluatePatch({place.tile, place.turns, place.depth, quarter.steps, quarter.a, quarter.b},
                    &quarter.u, &quarter.v, &row, 1);
      return;
    }
  }
  evaluateAlone(place, row);
}

template <typename Real>
void BatchEvaluator<Real>::evaluatePatch(const Patch& patch, const double* u, const double* v,
                                         const std::size_t* rows, unsigned count) {
  PatchRun run;
  if (patch.tile.kind == TileRef::kBSpline) {
    setBSpline(patch, run);
  } else {
    setRing(patch, count == 1, run);
  }
  run.turns = patch.turns;
  run.u = u;
  run.v = v;
  run.rows = rows;
  run.count = count;
  kernel_(run, results_);
  if (order_ >= 1 && results_.normal) {
    for (unsigned i = 0; i < count; ++i) {
      if (std::isnan(results_.normal[3 * rows[i]])) {
        const TileLocation own{patch.tile, std::ldexp(u[i] + patch.a, -patch.steps),
                               std::ldexp(v[i] + patch.b, -patch.steps), patch.turns, patch.depth};
        Jet jet;
        alone_.evaluateUpTo(order_, own, jet);  // the same du and dv as those in the results
        putNormal(own, jet, rows[i]);
      }
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::setBSpline(const Patch& patch, PatchRun& run) {
  const BSplineTile& tile = table_.bsplines[patch.tile.index];
  if (tile.fine) {
    for (int i = 0; i < 16; ++i) {
      const Padded point = pose_.difference(tile.points[i], tile.points[5]);
      std::copy_n(point.data(), 4, window_[i]);
    }
  } else {
    kernels_.gather(numbersOf(&pose_.point(0)), tile.points.data(), window_);
  }
  run.points = window_;
  run.stride = 4;
  run.u_low = tile.x_low;
  run.u_high = tile.x_high;
  run.v_low = tile.y_low;
  run.v_high = tile.y_high;
  copy(pose_.point(tile.points[5]), run.anchor);
  run.value_scale = 1;
  run.offset[0] = run.offset[1] = run.offset[2] = 0;
  run.first_scale = powerOfTwo(patch.depth);
  run.second_scale = powerOfTwo(2 * patch.depth);
  run.normal_limits = alone_.normalLimits(0, patch.depth);
}

template <typename Real>
void BatchEvaluator<Real>::setRing(const Patch& patch, bool is_single, PatchRun& run) {
  const int index = static_cast<int>(patch.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Padded* grid;
  if (patch.steps <= pose_.gridSteps(tile)) {
    const Pose::Grid& kept = pose_.grid(index, patch.steps);
    grid = kept.points;
    copy(kept.limit(), run.anchor);
    run.value_scale = 1;
    run.offset[0] = run.offset[1] = run.offset[2] = 0;
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
  run.normal_limits = alone_.normalLimits(patch.steps, patch.depth);
}

template <typename Real>
void BatchEvaluator<Real>::setDeep(const Patch& patch, bool is_single) {
  if (patch.tile.index == deep_tile_ && patch.steps == deep_steps_) {
    return;
  }
  const int index = static_cast<int>(patch.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Eigenbasis& basis = *table_.rings[tile.ring].basis;
  const Points& coefficients = pose_.ring(tile.ring).coefficients;
  const Padded* const outer = pose_.ringTile(index).outer;
  deep_tile_ = patch.tile.index;
  deep_steps_ = patch.steps;
  if (!TileEvaluator::needsNets(basis, order_)) {
    basis.controlGrid(tile.face, patch.steps, tile.ring_steps, coefficients, outer, deep_);
    return;
  }
  using derivative_nets::Selection;
  basis.derivativeNets(tile.face, patch.steps, tile.ring_steps, coefficients, outer,
                       is_single ? Selection::window(patch.a, patch.b) : Selection::whole(), deep_);
  if (is_single) {
    deep_steps_ = 0;  // the other quarters are missing
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateAlone(const TileLocation& place, std::size_t row) {
  Jet jet;
  alone_.evaluateUpTo(order_, place, jet);
  const auto put = [row](Real* to, const Padded& value) {
    for (int c = 0; c < 3; ++c) {
      to[3 * row + c] = static_cast<Real>(value[c]);
    }
  };
  put(results_.position, jet.anchor + jet.patch.value);
  if (order_ >= 1) {
    put(results_.du, jet.patch.du);
    put(results_.dv, jet.patch.dv);
    if (results_.normal) {
      putNormal(place, jet, row);
    }
  }
  if (order_ >= 2) {
    put(results_.duu, jet.second(jet.patch.duu));
    put(results_.duv, jet.second(jet.patch.duv));
    put(results_.dvv, jet.second(jet.patch.dvv));
  }
}

template <typename Real>
void BatchEvaluator<Real>::putNormal(const TileLocation& place, const Jet& jet, std::size_t row) {
  Vector3 normal;
  const int index = static_cast<int>(place.tile.index);
  if (!place.atVertex()) {
    normal = alone_.normalDirection(place, jet);
  } else if (vertexHasNormal(table_.rings[table_.ring_tiles[index].ring].basis->ring())) {
    normal = unitDirection(vertexApproach(table_, pose_, index, place.turns).normal);
  } else {
    normal.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  for (int c = 0; c < 3; ++c) {
    results_.normal[3 * row + c] = static_cast<Real>(normal[c]);
  }
}

template class BatchEvaluator<double>;
template class BatchEvaluator<float>;

}  // namespace limitsurf
