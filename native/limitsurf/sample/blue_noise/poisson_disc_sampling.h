// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "limitsurf/sample/blue_noise/cell_list.h"
#include "limitsurf/sample/blue_noise/cell_trials.h"
#include "limitsurf/sample/blue_noise/disc_grid.h"
#include "limitsurf/sample/density_field.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// Points of blue noise: the disc and the location of each.
struct NoisePoints {
  std::vector<NoiseDisc> discs;
  std::vector<Location> at;
};

/// Poisson-disc sampling by trials in ever smaller cells, in rounds (White, Cline, Egbert: "Poisson
/// Disk Point Sets by Hierarchical Dart Throwing", 2007; a dart is called a trial here, since a
/// dart is a crease that ends in this library).
///
/// The surface is cut into cells. In each round every cell makes one trial (CellTrials), and each
/// candidate that has the best rank among the candidates it conflicts with is accepted. What
/// happens in a cell follows from its own random bits and from the points accepted in earlier
/// rounds, so the result depends neither on the number of threads nor on their timing.
class PoissonDiscSampling {
 public:
  /// `radius` is that of the discs where the density is largest. Cells smaller than `gap` radii are
  /// discarded. `expected` is an estimate of the number of points that will be accepted.
  ///
  /// Cells are rectangles of (u, v). Where the parameters are sheared so strongly that there would
  /// be far more cells than points, run() throws std::invalid_argument.
  PoissonDiscSampling(const SurfacePatches& patches, const SettlingCores& settling, const Box& box,
                      const DensityField& density, double radius, double gap, double expected,
                      std::uint64_t seed, int threads);

  /// Accepts points until there is no room for another one, and returns them. Calls `report` from
  /// time to time with the number of points accepted so far. May be called once.
  NoisePoints run(const std::function<void(std::size_t points)>& report);

  /// The number of trials that run() has made: what its cost is proportional to.
  std::size_t trials() const { return trials_; }

 private:
  /// What one task does in a round.
  struct Task {
    CellTrials::Outcome outcome;
    std::size_t first = 0;  ///< the number of its first candidate
    std::vector<NoiseDisc> discs;
    std::vector<Location> points;  ///< those of its candidates that were accepted
    std::vector<TrialCell> cells;  ///< cells that may still have room
  };

  void makeFirstCells();
  /// Makes one trial in every cell.
  void makeTrials(const std::function<void(std::size_t)>& report);
  /// Accepts the candidates that win.
  void accept();
  /// Tells which candidates of a task win, and which cells are left.
  void decide(Task& task);

  NoiseSurface surface_;
  std::uint64_t key_;
  int threads_;

  int round_ = 0;
  std::size_t trials_ = 0;
  std::vector<std::vector<TrialCell>> first_cells_, last_cells_;  // what cells_ lists
  CellList cells_;
  std::vector<Task> tasks_;
  std::vector<Location> points_;
  DiscGrid accepted_, candidates_;
};

}  // namespace limitsurf
