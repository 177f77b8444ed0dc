// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/batch_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limitsurf/surface/batch/changed_locations.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_approach.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

template <typename Real>
BatchEvaluator<Real>::BatchEvaluator(const TileTable& table, const Pose& pose, int order,
                                     const PatchResults<Real>& results)
    : table_(table),
      pose_(pose),
      kernels_(PatchKernels::of<Real>()),
      order_(order),
      results_(results),
      runs_(table, pose, order),
      alone_(table, pose) {}

template <typename Real>
void BatchEvaluator<Real>::evaluate(const LocationBatch& at, const RowOrder& order,
                                    std::size_t begin, std::size_t end) {
  std::int64_t faces[kMostRows];
  double u[kMostRows + PatchRun::kReadBeyond], v[kMostRows + PatchRun::kReadBeyond];
  std::size_t rows[kMostRows];
  while (begin < end) {
    // Many rows are read before the first one is evaluated. In another order each may have to come
    // from memory, and the processor does not wait for one before it asks for the next.
    const auto count = static_cast<unsigned>(std::min<std::size_t>(kMostRows, end - begin));
    bool good = true;
    for (unsigned i = 0; i < count; ++i) {
      const std::size_t row = order[begin++];
      const double u_here = at.u(row), v_here = at.v(row);
      good &= (u_here >= 0) & (u_here <= 1) & (v_here >= 0) & (v_here <= 1);
      faces[i] = at.face(row);
      u[i] = u_here;
      v[i] = v_here;
      rows[i] = row;
    }
    if (!good) {
      throwChangedLocations();
    }
    std::fill_n(u + count, PatchRun::kReadBeyond, 0.);
    std::fill_n(v + count, PatchRun::kReadBeyond, 0.);
    evaluateFaces(faces, {u, v, rows, count});
  }
  evaluateSingles();
}

template <typename Real>
void BatchEvaluator<Real>::evaluateFaces(const std::int64_t faces[], const TileRows& rows) {
  constexpr unsigned kAhead = 8;  // single rows, until a tile has arrived
  for (unsigned first = 0, last; first < rows.count; first = last) {
    last = first + 1;
    while (last < rows.count && faces[last] == faces[first]) {
      ++last;
    }
    const TileRef tile = tileOf(faces[first]);
    if (tile.kind == TileRef::kNone) {
      throwChangedLocations();
    }
    const unsigned next = last == first + 1 ? first + kAhead : last;
    if (next < rows.count) {
      runs_.prefetchTile(tileOf(faces[next]));
    }
    const TileRows some{rows.u + first, rows.v + first, rows.rows + first, last - first};
    if (some.count == 1) {
      evaluateSingle(tile, some);
    } else {
      evaluateTile(tile, 0, 0, some);
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateSingle(TileRef tile, const TileRows& row) {
  if (tile.kind == TileRef::kBSpline) {
    const BSplineTile& regular = table_.bsplines[tile.index];
    if (!regular.hasEnds() && !regular.fine && !runs_.hasCrease(tile)) {
      const unsigned i = singles_.count++;
      singles_.tiles[i] = tile;
      singles_.indices[i] = regular.points.data();
      singles_.u[i] = *row.u;
      singles_.v[i] = *row.v;
      singles_.rows[i] = *row.rows;
      if (singles_.count == Singles::kMost) {
        evaluateSingles();
      }
      return;
    }
  }
  evaluateTile(tile, 0, 0, row);
}

template <typename Real>
void BatchEvaluator<Real>::evaluateSingles() {
  const unsigned count = std::exchange(singles_.count, 0);
  if (count == 0) {
    return;
  }
  SingleRun run;
  run.points = numbersOf(&pose_.point(0));
  run.indices = singles_.indices;
  run.u = singles_.u;
  run.v = singles_.v;
  run.rows = singles_.rows;
  run.count = count;
  const bool has_normals = order_ >= 1 && results_.normal;
  if (has_normals) {
    run.normal_limits = alone_.normalLimits(0, 0);
  }
  kernels_.singles[order_](run, results_);
  if (has_normals) {
    for (unsigned i = 0; i < count; ++i) {
      completeNormals(singles_.tiles[i], 0, 0,
                      {&singles_.u[i], &singles_.v[i], &singles_.rows[i], 1});
    }
  }
}

template <typename Real>
TileRef BatchEvaluator<Real>::tileOf(std::int64_t face) const {
  const auto index = static_cast<std::uint64_t>(face);
  return index < table_.faces.size() ? table_.faces[index] : TileRef{TileRef::kNone, 0};
}

template <typename Real>
void BatchEvaluator<Real>::evaluateTile(TileRef tile, int turns, int depth, const TileRows& rows) {
  constexpr unsigned kFewestRows = 3;  // fewer are located faster one by one
  if (tile.kind == TileRef::kBSpline && !runs_.hasCrease(tile)) {
    evaluatePatch({tile, turns & 3, depth, 0, 0, 0}, 1, rows);
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
RowParts& BatchEvaluator<Real>::partsAt(int depth) {
  while (static_cast<int>(parts_.size()) <= depth) {
    parts_.emplace_back();
  }
  return parts_[depth];
}

template <typename Real>
void BatchEvaluator<Real>::evaluateSplit(TileRef tile, int turns, int depth, const TileRows& rows) {
  RowParts& parts = partsAt(depth);
  parts.sortByChild(rows);
  parts.forEachPart([&](unsigned part, const TileRows& some) {
    const int child = static_cast<int>(part);
    if (child < 3) {
      runs_.prefetchTile(table_.splits[tile.index][child + 1]);
    }
    evaluateTile(table_.splits[tile.index][child], turns + child, depth + 1, some);
  });
}

template <typename Real>
void BatchEvaluator<Real>::evaluateRingTile(TileRef tile, int turns, int depth,
                                            const TileRows& rows) {
  const RingTile& ring_tile = table_.ring_tiles[tile.index];
  const int corner = ring_tile.corner;
  turns = (turns + corner) & 3;
  const int kept = pose_.gridSteps(ring_tile);
  const double least = powerOfTwo(-kept);  // on the grids that are kept
  double lowest = 1;
  unsigned below = 0;
  for (unsigned i = 0; i < rows.count; ++i) {
    turnParameters(corner, rows.u[i], rows.v[i]);
    const double larger = std::max(rows.u[i], rows.v[i]);
    lowest = std::min(lowest, larger);
    below += larger < least ? 1 : 0;
  }
  if (below > rows.count / 4) {
    evaluateQuarters(tile, turns, depth, rows);
    return;
  }
  const TileRows left = evaluateFirstQuarters(tile, turns, depth, rows);
  evaluateOnGrids(tile, std::min(kept, Quarter::stepsTo(lowest)), turns, depth, left);
  if (below > 0) {
    unsigned count = 0;
    for (unsigned i = 0; i < left.count; ++i) {
      if (std::max(left.u[i], left.v[i]) < least) {  // few are
        left.u[count] = left.u[i];
        left.v[count] = left.v[i];
        left.rows[count] = left.rows[i];
        ++count;
      }
    }
    evaluateQuarters(tile, turns, depth, {left.u, left.v, left.rows, count});
  }
}

template <typename Real>
TileRows BatchEvaluator<Real>::evaluateFirstQuarters(TileRef tile, int turns, int depth,
                                                     TileRows rows) {
  constexpr unsigned kFewestRows = 128;  // with fewer, sorting does not pay
  const int kept = pose_.gridSteps(table_.ring_tiles[tile.index]);
  for (int steps = 1; steps <= kept && rows.count >= kFewestRows; ++steps) {
    RowParts& parts = quarters_[steps - 1];
    if (!parts.sortsFast()) {
      break;
    }
    parts.sortByQuarterAfter(steps, rows);
    rows.count = 0;
    parts.forEachPart([&](unsigned part, const TileRows& some) {
      if (part == 0) {
        rows = some;
        return;
      }
      const TilePatch patch{
          tile, turns, depth, steps, static_cast<int>(part & 1), static_cast<int>(part >> 1)};
      evaluatePatch(patch, powerOfTwo(steps), some);
    });
  }
  return rows;
}

template <typename Real>
void BatchEvaluator<Real>::evaluateOnGrids(TileRef tile, int steps, int turns, int depth,
                                           const TileRows& rows) {
  if (rows.count == 0) {
    return;
  }
  GridRun run = runs_.onGrids(static_cast<int>(tile.index), steps, turns, depth);
  run.u = rows.u;
  run.v = rows.v;
  run.rows = rows.rows;
  run.count = rows.count;
  const bool has_normals = order_ >= 1 && results_.normal;
  if (has_normals) {
    run.normal_limits = alone_.normalLimits(steps, depth);
  }
  kernels_.on_grids[order_](run, results_);
  if (has_normals) {
    completeNormals(tile, turns, depth, rows);
  }
}

template <typename Real>
void BatchEvaluator<Real>::completeNormals(TileRef tile, int turns, int depth,
                                           const TileRows& rows) {
  for (unsigned i = 0; i < rows.count; ++i) {
    const TileLocation own{tile, rows.u[i], rows.v[i], turns, depth};
    if (std::isnan(results_.normal[3 * rows.rows[i]]) && !own.atVertex()) {
      Jet jet;
      alone_.evaluateUpTo(order_, own, jet);  // the same du and dv as those in the results
      putNormal(own, jet, rows.rows[i]);
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateQuarters(TileRef tile, int turns, int depth,
                                            const TileRows& rows) {
  constexpr unsigned kFewestRows = 3;  // sorting fewer takes longer than it saves
  if (rows.count < kFewestRows) {
    for (unsigned i = 0; i < rows.count; ++i) {
      evaluateOne({tile, rows.u[i], rows.v[i], turns, depth}, rows.rows[i]);
    }
    return;
  }
  bool is_any_on_spoke = false;
  for (unsigned i = 0; i < rows.count; ++i) {
    is_any_on_spoke |= (rows.u[i] == 0) | (rows.v[i] == 0);
  }
  const Eigenbasis& basis = *table_.rings[table_.ring_tiles[tile.index].ring].basis;
  const bool spokes_are_deep = is_any_on_spoke && TileEvaluator::needsNets(basis, order_);
  RowParts& parts = partsAt(depth);
  parts.sortByQuarter(rows, spokes_are_deep);
  parts.forEachPart([&](unsigned part, const TileRows& some) {
    if (part == RowParts::kDeep) {
      for (unsigned i = 0; i < some.count; ++i) {
        evaluateOne({tile, some.u[i], some.v[i], turns, depth}, some.rows[i]);
      }
      return;
    }
    const int steps = static_cast<int>(part / 4);
    const TilePatch patch{
        tile, turns, depth, steps, static_cast<int>(part & 1), static_cast<int>(part >> 1 & 1)};
    evaluatePatch(patch, powerOfTwo(steps), some);
  });
}

template <typename Real>
void BatchEvaluator<Real>::evaluateOne(TileLocation place, std::size_t row) {
  const TileRows single{&place.u, &place.v, &row, 1};
  if (place.tile.kind == TileRef::kBSpline) {
    if (!runs_.hasCrease(place.tile)) {
      evaluatePatch({place.tile, place.turns, place.depth, 0, 0, 0}, 1, single);
      return;
    }
  } else if (!place.atVertex()) {
    const Quarter quarter(place.u, place.v);
    const RingTile& tile = table_.ring_tiles[place.tile.index];
    const Eigenbasis& basis = *table_.rings[tile.ring].basis;
    if (quarter.steps <= pose_.gridSteps(tile) ||
        (quarter.steps <= static_cast<int>(RowParts::kMostSteps) &&
         !TileEvaluator::takesModes(basis, order_, place.u, place.v))) {
      evaluatePatch({place.tile, place.turns, place.depth, quarter.steps, quarter.a, quarter.b},
                    powerOfTwo(quarter.steps), single);
      return;
    }
  }
  evaluateAlone(place, row);
}

template <typename Real>
void BatchEvaluator<Real>::evaluatePatch(const TilePatch& patch, double scale,
                                         const TileRows& rows) {
  PatchRun run = runs_.onPatch(patch, rows.count == 1);
  run.u = rows.u;
  run.v = rows.v;
  run.scale = scale;
  run.rows = rows.rows;
  run.count = rows.count;
  const bool has_normals = order_ >= 1 && results_.normal;
  if (has_normals) {
    run.normal_limits = alone_.normalLimits(patch.steps, patch.depth);
  }
  kernels_.patches[order_](run, results_);
  if (has_normals) {
    completeNormals(patch.tile, patch.turns, patch.depth, rows);
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
