// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/batch/batch_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// A ring tile, and by how many steps the quarter of a location lies below it.
std::uint64_t ringKey(const TileLocation& place, int steps) {
  return (std::uint64_t{place.tile.index} << 16 | static_cast<std::uint64_t>(steps) << 2) << 2 |
         TileRef::kRing;
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
    const TileRef tile = table_.faces[face];
    if (tile.kind == TileRef::kBSpline && !(table_.bsplines[tile.index].crease > 0)) {
      evaluatePatch({tile, u[0], v[0], 0, 0}, u, v, rows, count);
    } else {
      evaluateFace(face, u, v, rows, count);
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::evaluateFace(int face, const double* u, const double* v,
                                        const std::size_t* rows, unsigned count) {
  if (count == 1) {
    const TileLocation place = alone_.locate({face, u[0], v[0]});
    double patch_u, patch_v;
    std::uint64_t key;
    if (onPatch(place, patch_u, patch_v, key)) {
      evaluatePatch(place, &patch_u, &patch_v, rows, 1);
    } else {
      evaluateAlone(place, rows[0]);
    }
    return;
  }
  constexpr unsigned kNone = std::numeric_limits<unsigned>::max();
  patches_.clear();
  slots_.assign(kSlots, 0);
  u_.resize(count);
  v_.resize(count);
  patch_of_.resize(count);
  for (unsigned i = 0; i < count; ++i) {
    const TileLocation place = alone_.locate({face, u[i], v[i]});
    std::uint64_t key;
    if (onPatch(place, u_[i], v_[i], key)) {
      patch_of_[i] = patchOf(key, place);
      ++patches_[patch_of_[i]].rows;
    } else {
      patch_of_[i] = kNone;
      evaluateAlone(place, rows[i]);
    }
  }
  unsigned first = 0;
  for (Patch& patch : patches_) {
    patch.first = first;
    first += patch.rows;
  }
  sorted_u_.resize(count);
  sorted_v_.resize(count);
  sorted_rows_.resize(count);
  for (unsigned i = 0; i < count; ++i) {
    if (patch_of_[i] != kNone) {
      const unsigned to = patches_[patch_of_[i]].first++;
      sorted_u_[to] = u_[i];
      sorted_v_[to] = v_[i];
      sorted_rows_[to] = rows[i];
    }
  }
  for (const Patch& patch : patches_) {
    const unsigned from = patch.first - patch.rows;
    evaluatePatch(patch.place, &sorted_u_[from], &sorted_v_[from], &sorted_rows_[from], patch.rows);
  }
}

template <typename Real>
bool BatchEvaluator<Real>::onPatch(const TileLocation& place, double& u, double& v,
                                   std::uint64_t& key) const {
  if (place.tile.kind == TileRef::kBSpline) {
    u = place.u;
    v = place.v;
    key = std::uint64_t{place.tile.index} << 2 | TileRef::kBSpline;
    return !(table_.bsplines[place.tile.index].crease > 0);
  }
  if (place.atVertex()) {
    return false;
  }
  const RingTile& tile = table_.ring_tiles[place.tile.index];
  const Quarter quarter(place.u, place.v);
  u = quarter.u;
  v = quarter.v;
  key = ringKey(place, quarter.steps) | static_cast<std::uint64_t>(quarter.a + 2 * quarter.b) << 2;
  return quarter.steps <= pose_.gridSteps(tile) ||
         !TileEvaluator::addsModesAt(*table_.rings[tile.ring].basis, order_);
}

template <typename Real>
unsigned BatchEvaluator<Real>::patchOf(std::uint64_t key, const TileLocation& place) {
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15;  // Knuth's multiplicative hashing
  unsigned slot = static_cast<unsigned>(key * kGoldenRatio >> 32) % kSlots;
  while (slots_[slot] != 0) {
    const unsigned patch = slots_[slot] - 1;
    if (patches_[patch].key == key) {
      return patch;
    }
    slot = (slot + 1) % kSlots;
  }
  patches_.push_back({key, place, 0, 0});
  slots_[slot] = static_cast<unsigned>(patches_.size());
  return slots_[slot] - 1;
}

template <typename Real>
void BatchEvaluator<Real>::evaluatePatch(const TileLocation& place, const double* u,
                                         const double* v, const std::size_t* rows, unsigned count) {
  PatchRun run;
  if (place.tile.kind == TileRef::kBSpline) {
    setBSpline(place, run);
  } else {
    setRing(place, run);
  }
  run.turns = place.turns;
  run.u = u;
  run.v = v;
  run.rows = rows;
  run.count = count;
  kernel_(run, results_);
  if (order_ >= 1 && results_.normal) {
    for (unsigned i = 0; i < count; ++i) {
      if (std::isnan(results_.normal[3 * rows[i]])) {
        TileLocation own = place;
        own.u = u[i];
        own.v = v[i];
        if (place.tile.kind == TileRef::kRing) {  // from the quarter's parameters to the tile's
          const Quarter quarter(place.u, place.v);
          own.u = std::ldexp(u[i] + quarter.a, -quarter.steps);
          own.v = std::ldexp(v[i] + quarter.b, -quarter.steps);
        }
        Jet jet;
        alone_.evaluate<1>(own, jet);
        putNormal(own, jet, rows[i]);
      }
    }
  }
}

template <typename Real>
void BatchEvaluator<Real>::setBSpline(const TileLocation& place, PatchRun& run) {
  const BSplineTile& tile = table_.bsplines[place.tile.index];
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
  run.first_scale = powerOfTwo(place.depth);
  run.second_scale = powerOfTwo(2 * place.depth);
  run.lowest_sine_square = 0;
}

template <typename Real>
void BatchEvaluator<Real>::setRing(const TileLocation& place, PatchRun& run) {
  const int index = static_cast<int>(place.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Quarter quarter(place.u, place.v);
  const Padded* grid;
  if (quarter.steps <= pose_.gridSteps(tile)) {
    const Pose::Grid& kept = pose_.grid(index, quarter.steps);
    grid = kept.points;
    copy(kept.limit(), run.anchor);
    run.value_scale = 1;
    run.offset[0] = run.offset[1] = run.offset[2] = 0;
    run.first_scale = powerOfTwo(quarter.steps + place.depth);
    run.second_scale = powerOfTwo(2 * (quarter.steps + place.depth));
  } else {
    const Pose::RingPose& ring = pose_.ring(tile.ring);
    const std::uint64_t key = ringKey(place, quarter.steps);
    if (key != deep_key_) {
      table_.rings[tile.ring].basis->controlGrid(tile.face, quarter.steps, tile.ring_steps,
                                                 ring.coefficients, pose_.ringTile(index).outer,
                                                 deep_);
      deep_key_ = key;
    }
    grid = deep_;
    copy(ring.limit, run.anchor);
    copy(ring.constant(), run.offset);
    run.value_scale = std::ldexp(1., 1 - quarter.steps);
    run.first_scale = powerOfTwo(1 + place.depth);
    run.second_scale = 0;  // second derivatives are evaluated alone there
  }
  run.points = numbersOf(grid + quarter.b * tile_grid::kSize + quarter.a);
  run.stride = tile_grid::kSize;
  run.u_low = onRight(tile.sides) && quarter.a == 0;
  run.v_low = onLeft(tile.sides) && quarter.b == 0;
  run.u_high = run.v_high = false;
  run.lowest_sine_square = TileEvaluator::lowestSineSquare(place);
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
