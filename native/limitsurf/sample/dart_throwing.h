// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "limitsurf/sample/dart_cell.h"
#include "limitsurf/sample/density_field.h"
#include "limitsurf/sample/disc_grid.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// A point of blue noise.
struct Dart {
  Vector3 position, normal;
  double radius;
  Location at;
};

/// Poisson-disk sampling by hierarchical dart throwing (White, Cline, Egbert 2007), in rounds.
///
/// The surface is cut into cells. In each round each cell throws a dart into itself. Of those that
/// are in conflict with no accepted one, each that has the best rank among its rivals is accepted.
/// A cell whose dart failed is given up if it lies wholly in the disc of one accepted dart, else it
/// is cut in smaller ones, until these are too small to matter. What a cell does follows from its
/// own random bits and from the darts accepted before, so neither threads nor their order count.
class DartThrowing {
 public:
  /// `radius`: of the discs where the density is largest. `gap`: cells that are smaller than so
  /// many radii are given up. `expected`: about so many darts will be accepted.
  ///
  /// Cells are rectangles of (u, v). Where these are sheared so strongly that there would be far
  /// more cells than darts, run() throws std::invalid_argument.
  DartThrowing(const SurfacePatches& patches, const Box& box, const DensityField& density,
               double radius, double gap, double expected, std::uint64_t seed, int threads);

  /// Until no place is left. Tells now and then how many darts there are.
  void run(const std::function<void(std::size_t darts)>& report);

  std::vector<Dart>& darts() { return darts_; }

 private:
  struct Proposal {
    Dart dart;
    double rank;  // the lower the better
    DartCell cell;
  };
  struct Outcome {
    std::vector<Proposal> proposals;
    std::vector<DartCell> parts;
  };
  class Thrower;

  double radiusOf(double weight) const;
  std::vector<DartCell> firstCells();
  void throwDarts(const std::function<void(std::size_t)>& report, std::vector<Proposal>& proposals,
                  std::vector<DartCell>& parts) const;
  /// Accepts the winners and lists the cells of all whose places are still open.
  void accept(const std::vector<Proposal>& proposals, std::vector<DartCell>& open);

  const SurfacePatches& patches_;
  const DensityField& density_;
  double radius_, largest_radius_, gap_, most_cells_;
  std::uint64_t key_;
  int threads_;

  int round_ = 0;
  std::atomic<std::size_t> first_cells_{0};
  std::vector<DartCell> cells_;
  std::vector<Dart> darts_;
  DiscGrid accepted_, proposed_;
};

}  // namespace limitsurf
