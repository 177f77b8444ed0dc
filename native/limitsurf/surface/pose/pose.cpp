// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/pose/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/batch/grid_step.h"

namespace limitsurf {
namespace {

/// Tasks take 100 microseconds and more. Small meshes are one task, because waking other cores
/// would take as long.
constexpr std::size_t kRingsPerTask = 256;

Padded padded(const Vector3& v) { return {v[0], v[1], v[2], 0}; }

/// The error of rounding a + b to `sum`, whichever of a and b is the larger (Knuth's two-sum).
Padded rounding(const Padded& a, const Padded& b, const Padded& sum) {
  const Padded added = sum - a;
  return (a - (sum - added)) + (b - added);
}

/// Appends values until there are `count`. The system hands out memory when it is first written to,
/// which may take seconds: that can be interrupted.
template <typename T, typename... Value>
void fill(std::vector<T>& values, std::size_t count, const Value&... value) {
  InterruptionStride stride;
  values.reserve(count);
  while (values.size() < count) {
    stride.step();
    values.emplace_back(value...);
  }
}

}  // namespace

Pose::Pose(const TileTable& table, const PosePart* part)
    : table_(&table),
      part_(part),
      ring_steps_(table.rings.size(), 0),
      steps_made_(table.ring_tiles.size()) {
  fill(rings_, table.rings.size());
  std::size_t tiles[TileTable::kMostDepth + 1] = {};
  for (const RingTile& tile : table.ring_tiles) {
    ++tiles[tile.depth];
  }
  std::size_t grids = 0;
  for (int fewer = 0; fewer < kMostGridSteps; ++fewer) {
    grids = 0;
    for (int depth = 0; depth <= TileTable::kMostDepth; ++depth) {
      grid_steps_[depth] = std::max(1, kMostGridSteps - depth - fewer);
      grids += tiles[depth] * static_cast<std::size_t>(grid_steps_[depth]);
    }
    if (grids * sizeof(Grid) <= kGridBytes) {
      break;
    }
  }
  first_grid_.reserve(table.ring_tiles.size());
  std::size_t next = 0;
  for (const RingTile& tile : table.ring_tiles) {
    first_grid_.push_back(next);
    next += static_cast<std::size_t>(gridSteps(tile));
    int& steps = ring_steps_[tile.ring];
    steps = std::max(steps, tile.ring_steps + gridSteps(tile));
  }
  first_level_.reserve(table.rings.size());
  std::size_t level_points = 0;
  for (std::size_t ring = 0; ring < table.rings.size(); ++ring) {
    first_level_.push_back(level_points);
    level_points +=
        table.rings[ring].points.size() * static_cast<std::size_t>(ring_steps_[ring] + 1);
  }
  // The system hands out their memory, page by page, when it is first written to.
  grids_.reset(new Grid[grids]);
  ring_levels_.reset(new Padded[level_points]);
}

namespace {

/// The largest power of two that is no larger.
double powerOfTwo(double size) { return size > 0 ? std::ldexp(1, std::ilogb(size)) : 1; }

}  // namespace

void Pose::set(const RowsIn<Points>& cage, int threads) {
  is_set_ = false;
  const RefinedPoints& refined = table_->points;
  points_.resize(static_cast<std::size_t>(refined.size()));
  size_ = padPoints(cage, points_.data(), threads);
  residual_unit_ = powerOfTwo(size_.largest_coordinate);
  refinePoints();
  steps_made_.clear();
  const std::size_t rings = part_ ? part_->rings.size() : rings_.size();
  parallelFor(rings, kRingsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Padded> memory;
    for (std::size_t i = begin; i < end; ++i) {
      setRing(part_ ? part_->rings[i] : static_cast<int>(i), memory);
    }
  });
  is_set_ = true;
}

template <bool kFine>
void Pose::refinePoint(int i) {
  const RefinedPoints& refined = table_->points;
  const Span<int> sources = refined.sources(i);
  const Span<double> weights = refined.weights(i);
  const auto residualOf = [&](int point) {
    return kFine ? residual(point) : Padded(Padded::Zero());
  };
  const auto setResidual = [&](const Padded& value) {
    for (int c = 0; c < 3; ++c) {
      residuals_[i - refined.cagePoints()][c] = static_cast<float>(value[c] / residual_unit_);
    }
  };
  Padded base, sum;
  if (sources.size() == 2 && weights[0] == weights[1]) {
    // A midpoint, with the same bits from either end: faces on different sides of a sharp edge may
    // each have made one.
    base = points_[sources[0]] / 2;
    sum = points_[sources[1]] / 2;
    points_[i] = base + sum;
    if (kFine) {
      setResidual(rounding(base, sum, points_[i]) +
                  (residualOf(sources[0]) / 2 + residualOf(sources[1]) / 2));
    }
    return;
  }
  // The sum is taken relative to one of the sources, to keep the digits of small faces far from the
  // origin.
  base = points_[sources[0]];
  const Padded base_residual = residualOf(sources[0]);
  sum = base_residual;
  for (std::size_t s = 1; s < sources.size(); ++s) {
    Padded difference = points_[sources[s]] - base;
    if (kFine) {
      difference += residualOf(sources[s]) - base_residual;
    }
    sum += weights[s] * difference;
  }
  points_[i] = base + sum;
  if (kFine) {
    setResidual(rounding(base, sum, points_[i]));
  }
}

void Pose::refinePoints() {
  const RefinedPoints& refined = table_->points;
  const int cage = refined.cagePoints();
  residuals_.resize(table_->fine ? static_cast<std::size_t>(refined.size() - cage) : 0);
  InterruptionStride stride;
  const auto refine = [&](int point) {
    stride.step();
    if (table_->fine) {
      refinePoint<true>(point);
    } else {
      refinePoint<false>(point);
    }
  };
  if (part_) {
    std::for_each(part_->points.begin(), part_->points.end(), refine);
    return;
  }
  for (int i = cage; i < refined.size(); ++i) {  // a point's sources have smaller numbers
    refine(i);
  }
}

void Pose::setRing(int ring_index, std::vector<Padded>& memory) {
  const RingPoints& ring = table_->rings[ring_index];
  RingPose& pose = rings_[ring_index];
  const Padded vertex = points_[ring.points[0]];
  const std::size_t size = ring.points.size();
  Padded* const levels = ringLevels(ring_index);
  for (std::size_t i = 0; i < size; ++i) {
    levels[i] = difference(ring.points[i], ring.points[0]);
  }
  memory.assign(levels, levels + size);
  ring.basis->projectInPlace(memory.data(), pose.coefficients);
  pose.largest = pose.coefficients.bottomRows(pose.coefficients.rows() - 1).cwiseAbs().maxCoeff();
  const Padded to_limit = padded(pose.coefficients.row(0));
  pose.limit = vertex + to_limit;
  // The coefficient of the constant mode relative to the limit as it is stored: its rounding error.
  pose.coefficients.row(0) =
      ((vertex - pose.limit) + (to_limit + residual(ring.points[0]))).head<3>().transpose();

  for (std::size_t i = 0; i < size; ++i) {
    levels[i] -= to_limit;
  }
  for (int step = 0; step < ring_steps_[ring_index]; ++step) {
    const Padded* const before = levels + size * static_cast<std::size_t>(step);
    Padded* const after = levels + size * (static_cast<std::size_t>(step) + 1);
    ring.basis->step().apply([=](int i) -> const Padded& { return before[i]; },
                             [=](int i) -> Padded& { return after[i]; });
  }
}

Pose::OuterPoints Pose::outerPoints(int t) const {
  const RingTile& tile = table_->ring_tiles[t];
  const Padded& limit = rings_[tile.ring].limit;
  const std::size_t count = table_->rings[tile.ring].basis->outerModes(tile.face).slots().size();
  OuterPoints outer;
  for (std::size_t i = 0; i < count; ++i) {
    outer.points[i] = (points_[tile.outer[i]] - limit) + residual(tile.outer[i]);
  }
  return outer;
}

const Pose::Grid* Pose::madeGrids(int tile, int steps, OwnGrids& own) const {
  const int made = steps_made_.claim(tile);
  if (made == StepsMade::kClaimedByOther) {
    own.resize(kMostGridSteps);
    makeGrids(tile, 0, steps, own.data());
    return own.data();
  }
  Grid* const kept = &grids_[first_grid_[tile]];
  makeGrids(tile, made, steps, kept);
  steps_made_.put(tile, std::max(made, steps));  // another thread may have made more meanwhile
  return kept;
}

void Pose::makeGrids(int t, int made, int steps, Grid grids[]) const {
  const RingTile& tile = table_->ring_tiles[t];
  const Eigenbasis& basis = *table_->rings[tile.ring].basis;
  const RingPose& ring = rings_[tile.ring];
  const std::size_t ring_size = table_->rings[tile.ring].points.size();
  const Padded* points =  // of the ring
      ringLevels(tile.ring) + ring_size * static_cast<std::size_t>(tile.ring_steps + made);

  const GridStep step(basis.ring(), tile.face);
  Grid start;  // what has no slot there is not read
  if (made == 0) {
    step.setRing(points, start.points);
    const OuterPoints outer = outerPoints(t);
    const std::vector<int>& slots = basis.outerModes(tile.face).slots();
    const Padded constant = ring.constant();  // the ring's points are without it
    for (std::size_t i = 0; i < slots.size(); ++i) {
      start.points[slots[i]] = outer.points[i] - constant;
    }
  }
  const Padded* before = made == 0 ? start.points : grids[made - 1].points;
  for (; made < steps; ++made) {
    Padded* after = grids[made].points;
    points += ring_size;
    step.apply(points, before, after);
    step.clearUnused(after);
    after[tile_grid::slot(-1, -1)] = ring.limit;
    before = after;
  }
}

}  // namespace limitsurf
