// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "limitsurf/sample/bounded_patch.h"
#include "limitsurf/sample/core_descent.h"
#include "limitsurf/sample/density_field.h"
#include "limitsurf/sample/disc_grid.h"
#include "limitsurf/sample/trial_cell.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// A point of blue noise, or a candidate for one, with the disc that it keeps free of others.
struct NoisePoint {
  Vector3 position, normal;
  double radius;
  Location at;
};

/// Poisson-disc sampling by trials in ever smaller cells, in rounds (White, Cline, Egbert: "Poisson
/// Disk Point Sets by Hierarchical Dart Throwing", 2007; a dart is called a trial here, since a
/// dart is a crease that ends in this library).
///
/// The surface is cut into cells. In each round every cell makes one trial: a random point of the
/// cell. A point that conflicts with no accepted point becomes a candidate, and each candidate that
/// has the best rank among the candidates it conflicts with is accepted. A cell whose trial failed
/// is discarded if the disc of one accepted point covers it wholly; otherwise it is split, until
/// its parts are too small to matter. What happens in a cell follows from its own random bits and
/// from the points accepted in earlier rounds, so the result depends neither on the number of
/// threads nor on their timing.
class PoissonDiscSampling {
 public:
  /// `radius` is that of the discs where the density is largest. Cells smaller than `gap` radii are
  /// discarded. `expected` is an estimate of the number of points that will be accepted.
  ///
  /// Cells are rectangles of (u, v). Where the parameters are sheared so strongly that there would
  /// be far more cells than points, run() throws std::invalid_argument.
  PoissonDiscSampling(const SurfacePatches& patches, const Box& box, const DensityField& density,
                      double radius, double gap, double expected, std::uint64_t seed, int threads);

  /// Accepts points until there is no room for another one. Calls `report` from time to time with
  /// the number of points accepted so far.
  void run(const std::function<void(std::size_t points)>& report);

  std::vector<NoisePoint>& points() { return points_; }
  /// The number of trials that run() has made: what its cost is proportional to.
  std::size_t trials() const { return trials_; }

 private:
  struct Candidate {
    NoisePoint point;
    double rank;  // the lowest rank wins
    TrialCell cell;
  };
  /// What the trials of some cells led to.
  struct Outcome {
    std::vector<Candidate> candidates;
    std::vector<TrialCell> parts;
  };
  class CellTrials;

  double radiusOf(double weight) const;
  std::vector<TrialCell> firstCells();
  /// Makes one trial in every cell. Lists the candidates, and the parts of cells that were split.
  void makeTrials(const std::function<void(std::size_t)>& report,
                  std::vector<Candidate>& candidates, std::vector<TrialCell>& parts) const;
  /// Accepts the candidates that win, and appends the cells that may still have room to `open`.
  void accept(const std::vector<Candidate>& candidates, std::vector<TrialCell>& open);

  const SurfacePatches& patches_;
  const DensityField& density_;
  double radius_, largest_radius_, gap_, most_cells_;
  std::uint64_t key_;
  int threads_;

  int round_ = 0;
  std::size_t trials_ = 0;
  std::atomic<std::size_t> first_cells_{0};
  /// Of the one cell of each tile that is a core, once it is needed. Only what tries this cell
  /// writes to it.
  mutable std::vector<CoreExtent> cores_;
  std::vector<TrialCell> cells_;
  std::vector<NoisePoint> points_;
  DiscGrid accepted_, candidates_;
};

}  // namespace limitsurf
