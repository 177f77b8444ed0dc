// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/pose.h"

#include <algorithm>

#include "limitsurf/eigen/ring_slots.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// A point takes a small part of the time of an evaluation, a ring much more than one.
constexpr std::size_t kPointsPerTask = 16384, kRingsPerTask = 16, kTilesPerTask = 64;

/// Rings with more faces are set one after the other, each on all cores.
constexpr int kManyFaces = 512;

Padded padded(const Vector3& v) { return {v[0], v[1], v[2], 0}; }

/// The error of rounding a + b to `sum`, whichever of a and b is the larger (Knuth's two-sum).
Padded rounding(const Padded& a, const Padded& b, const Padded& sum) {
  const Padded added = sum - a;
  return (a - (sum - added)) + (b - added);
}

/// The rules for a cubic B-spline's new control points at an old one and between two.
Padded atVertex(const Padded& before, const Padded& here, const Padded& after) {
  return (before + 6 * here + after) / 8;
}
Padded betweenVertices(const Padded& a, const Padded& b) { return (a + b) / 2; }

/// The slots from `from` on, `step` apart: those at -1 to 3 along one side of a strip that is one
/// step away from the vertex. `column(i)` returns the points of the coarser strip from -1 to 2.
/// Where the strip begins at a boundary there is nothing at -1, and the points at 0 follow the
/// curve.
template <typename Column>
void stepStrip(bool from_boundary, const Column& column, Padded* from, int step, int last) {
  if (from_boundary) {
    from[step] = column(0);
  } else {
    from[0] = betweenVertices(column(-1), column(0));
    from[step] = atVertex(column(-1), column(0), column(1));
  }
  from[2 * step] = betweenVertices(column(0), column(1));
  if (last > 1) {
    from[3 * step] = atVertex(column(0), column(1), column(2));
    from[4 * step] = betweenVertices(column(1), column(2));
  }
}

/// The slots with x or y above 1 after a step. Around them all is regular, so that a step is a
/// product of the rule of a cubic B-spline along u and the same along v.
void stepOutsideRing(Sides sides, const Padded before[], Padded after[]) {
  using tile_grid::slot;
  constexpr int kAlongU = slot(1, 0) - slot(0, 0), kAlongV = slot(0, 1) - slot(0, 0);
  Padded vertices[4], edges[4];  // of the strip's lines, from -1 to 2
  const auto stepAcross = [&](int first, int across, int count, bool skips_first) {
    for (int i = skips_first ? 1 : 0; i < count; ++i) {
      // `first` is at 0 across the strip.
      const Padded* const at = &before[first + i * (across == kAlongU ? kAlongV : kAlongU)];
      vertices[i] = atVertex(at[0], at[across], at[2 * across]);
      edges[i] = betweenVertices(at[across], at[2 * across]);
    }
  };
  stepAcross(slot(0, -1), kAlongU, 4, onLeft(sides));
  stepStrip(onLeft(sides), [&](int y) { return vertices[y + 1]; }, &after[slot(2, -1)], kAlongV, 3);
  stepStrip(onLeft(sides), [&](int y) { return edges[y + 1]; }, &after[slot(3, -1)], kAlongV, 3);
  stepAcross(slot(-1, 0), kAlongV, 3, onRight(sides));
  stepStrip(
      onRight(sides), [&](int x) { return vertices[x + 1]; }, &after[slot(-1, 2)], kAlongU, 1);
  stepStrip(onRight(sides), [&](int x) { return edges[x + 1]; }, &after[slot(-1, 3)], kAlongU, 1);
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
  stepOutsideRing(ring.sides(face), before, after);
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
  std::vector<int> large;
  for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
    if (table_->rings[ring].basis->ring().faces > kManyFaces) {
      large.push_back(static_cast<int>(ring));
    }
  }
  parallelFor(rings_.size(), kRingsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t ring = begin; ring < end; ++ring) {
      if (table_->rings[ring].basis->ring().faces <= kManyFaces) {
        setRing(static_cast<int>(ring), 1);
      }
    }
  });
  for (const int ring : large) {
    setRing(ring, threads);
  }
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

void Pose::setRing(int ring_index, int threads) {
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
  const int first = first_tile_[ring_index], end = first_tile_[ring_index + 1];
  int steps = 0;
  for (int t = first; t < end; ++t) {
    const RingTile& tile = table_->ring_tiles[t];
    steps = std::max(steps, tile.ring_steps + gridSteps(tile));
  }
  levels.resize(ring.points.size() * (static_cast<std::size_t>(steps) + 1));
  for (int step = 0; step < steps; ++step) {
    const Padded* before = &levels[ring.points.size() * static_cast<std::size_t>(step)];
    Padded* after = &levels[ring.points.size() * (static_cast<std::size_t>(step) + 1)];
    ring.basis->step().apply([=](int i) -> const Padded& { return before[i]; },
                             [=](int i) -> Padded& { return after[i]; });
  }
  parallelFor(static_cast<std::size_t>(end - first), kTilesPerTask, threads,
              [&](std::size_t begin_tile, std::size_t end_tile) {
                for (std::size_t t = begin_tile; t < end_tile; ++t) {
                  setRingTile(first + static_cast<int>(t), levels);
                }
              });
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
