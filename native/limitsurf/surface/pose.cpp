// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/pose.h"

#include <algorithm>

#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A point takes a small part of the time of an evaluation, a ring much more than one.
constexpr std::size_t kPointsPerTask = 16384, kRingsPerTask = 16;

Padded padded(const Vector3& v) { return {v[0], v[1], v[2], 0}; }

/// The error of rounding a + b to `sum`, whichever of a and b is the larger (Knuth's two-sum).
Padded rounding(const Padded& a, const Padded& b, const Padded& sum) {
  const Padded added = sum - a;
  return (a - (sum - added)) + (b - added);
}

const TileStep<double>& tileStep(Sides sides) {
  static const TileStep<double> steps[4] = {
      TileStep<double>(Sides::inner), TileStep<double>(Sides::left), TileStep<double>(Sides::right),
      TileStep<double>(Sides::both)};
  return steps[static_cast<int>(sides)];
}

void setRingValues(const Ring& ring, int face, const Padded points[], Padded grid[]) {
  forEachRingSlot(ring, face, [&](int slot, int point) { grid[slot] = points[point]; });
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

void stepGrid(const Ring& ring, int face, const Padded ring_points[], const Padded before[],
              Padded after[]) {
  tileStep(ring.sides(face)).apply(before, after);
  setRingValues(ring, face, ring_points, after);
}

Pose::Pose(const TileTable& table) : table_(&table), first_tile_(table.rings.size() + 1, 0) {
  fill(rings_, table.rings.size());
  fill(ring_tiles_, table.ring_tiles.size());
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
  Grid empty;  // slots without a point stay 0
  std::fill_n(empty.points, tile_grid::kSlots, Padded::Zero());
  fill(grids_, grids, empty);
  std::size_t next = 0;
  for (std::size_t t = 0; t < ring_tiles_.size(); ++t) {
    const RingTile& tile = table.ring_tiles[t];
    first_tile_[tile.ring + 1] = static_cast<int>(t) + 1;
    ring_tiles_[t].first_grid = next;
    next += static_cast<std::size_t>(gridSteps(tile));
  }
}

namespace {

double extentOf(const Padded* points, std::size_t count) {
  Padded low = count > 0 ? points[0] : Padded(Padded::Zero()), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    low = low.min(points[i]);
    high = high.max(points[i]);
  }
  return (high - low).maxCoeff();
}

}  // namespace

void Pose::set(const Points& cage, int threads) {
  is_set_ = false;
  const RefinedPoints& refined = table_->points;
  points_.resize(static_cast<std::size_t>(refined.size()));
  parallelFor(static_cast<std::size_t>(cage.rows()), kPointsPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  points_[i] = padded(cage.row(static_cast<Eigen::Index>(i)).transpose());
                }
              });
  extent_ = extentOf(points_.data(), static_cast<std::size_t>(cage.rows()));
  refinePoints();
  parallelFor(rings_.size(), kRingsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t ring = begin; ring < end; ++ring) {
      setRing(static_cast<int>(ring));
    }
  });
  is_set_ = true;
}

void Pose::refinePoints() {
  const RefinedPoints& refined = table_->points;
  const int cage = refined.cagePoints();
  residuals_.resize(table_->fine ? static_cast<std::size_t>(refined.size() - cage) : 0);
  InterruptionStride stride;
  for (int i = cage; i < refined.size(); ++i) {  // a point's sources have smaller numbers
    stride.step();
    const Span<int> sources = refined.sources(i);
    const std::vector<double>& weights = refined.weights(i);
    Padded base, sum;
    if (sources.size() == 2 && weights[0] == weights[1]) {
      // A midpoint, with the same bits from either end: faces on different sides of a sharp edge
      // may each have made one.
      base = points_[sources[0]] / 2;
      sum = points_[sources[1]] / 2;
      if (table_->fine) {
        const Padded rest = residual(sources[0]) / 2 + residual(sources[1]) / 2;
        points_[i] = base + sum;
        residuals_[i - cage] = rounding(base, sum, points_[i]) + rest;
        continue;
      }
    } else {
      // The sum is taken relative to one of the sources, to keep the digits of small faces far from
      // the origin.
      base = points_[sources[0]];
      sum = residual(sources[0]);
      for (std::size_t s = 1; s < sources.size(); ++s) {
        sum += weights[s] * difference(sources[s], sources[0]);
      }
    }
    points_[i] = base + sum;
    if (table_->fine) {
      residuals_[i - cage] = rounding(base, sum, points_[i]);
    }
  }
}

void Pose::setRing(int ring_index) {
  const RingPoints& ring = table_->rings[ring_index];
  RingPose& pose = rings_[ring_index];
  const Padded vertex = points_[ring.points[0]];
  Points points(ring.points.size(), 3);
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    points.row(static_cast<Eigen::Index>(i)) =
        difference(ring.points[i], ring.points[0]).head<3>().transpose();
  }
  ring.basis->project(points, pose.coefficients);
  const Vector3 to_limit = pose.coefficients.row(0);
  pose.limit = vertex + padded(to_limit);
  // The coefficient of the constant mode relative to the limit as it is stored: its rounding error.
  pose.coefficients.row(0) =
      ((vertex - pose.limit) + (padded(to_limit) + residual(ring.points[0]))).head<3>().transpose();

  // The ring's points after 0, 1, 2, ... steps, one ring after the other.
  std::vector<Padded> levels(ring.points.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i] = padded(points.row(static_cast<Eigen::Index>(i)).transpose() - to_limit);
  }
  for (int t = first_tile_[ring_index]; t < first_tile_[ring_index + 1]; ++t) {
    const RingTile& tile = table_->ring_tiles[t];
    const int steps = tile.ring_steps + gridSteps(tile);
    while (levels.size() <= ring.points.size() * static_cast<std::size_t>(steps)) {
      const std::size_t size = levels.size();
      levels.resize(size + ring.points.size());
      const Padded* before = &levels[size - ring.points.size()];
      Padded* after = &levels[size];
      ring.basis->step().apply([=](int i) -> const Padded& { return before[i]; },
                               [=](int i) -> Padded& { return after[i]; });
    }
    setRingTile(t, levels);
  }
}

void Pose::setRingTile(int t, const std::vector<Padded>& ring_levels) {
  const RingTile& tile = table_->ring_tiles[t];
  const Eigenbasis& basis = *table_->rings[tile.ring].basis;
  const Padded& limit = rings_[tile.ring].limit;
  const Padded constant = rings_[tile.ring].constant();  // the ring's points are without it
  const std::size_t ring_size = table_->rings[tile.ring].points.size();
  const Padded* ring = &ring_levels[ring_size * static_cast<std::size_t>(tile.ring_steps)];
  RingTilePose& pose = ring_tiles_[t];

  Grid start;
  for (Padded& point : start.points) {
    point.setZero();
  }
  setRingValues(basis.ring(), tile.face, ring, start.points);
  const std::vector<int>& slots = basis.outerModes(tile.face).slots();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    pose.outer[i] = (points_[tile.outer[i]] - limit) + residual(tile.outer[i]);
    start.points[slots[i]] = pose.outer[i] - constant;
  }
  const Padded* before = start.points;
  for (int n = 1; n <= gridSteps(tile); ++n) {
    Padded* after = grids_[pose.first_grid + n - 1].points;
    ring += ring_size;
    stepGrid(basis.ring(), tile.face, ring, before, after);
    after[tile_grid::slot(-1, -1)] = limit;
    before = after;
  }
}

}  // namespace limitsurf
