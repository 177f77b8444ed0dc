// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/sample/area_cells.h"
#include "limitsurf/sample/density_field.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// Picks cells at random, each with a probability in proportion to its weight.
class CellTable {
 public:
  /// The weight of a cell is its bound times the largest density on it. `largest` is empty if the
  /// density is 1 everywhere.
  explicit CellTable(const std::vector<AreaCell>& cells, std::vector<float> largest = {});

  double total() const { return sums_.empty() ? 0 : sums_.back(); }

  struct Choice {
    std::size_t cell;
    double rest;  ///< in [0, 1): how far into the cell's share of all weights the number fell
  };
  /// The cell that a random number in [0, 1) picks.
  Choice pick(double random) const;
  /// The largest density on a cell.
  double largest(std::size_t cell) const { return largest_.empty() ? 1 : largest_[cell]; }

 private:
  std::vector<float> largest_;  // of the density, cell by cell; empty if it is constant
  std::vector<double> sums_;    // the weights of a cell and of all before it, added up
  // For each of cells.size() equal parts of the total weight, the cell in which the part begins.
  std::vector<std::uint32_t> first_;
};

/// The largest density on each cell, rounded up; empty if the density is constant.
std::vector<float> largestDensities(const SurfacePatches& patches,
                                    const std::vector<AreaCell>& cells, const DensityField& density,
                                    int threads);

}  // namespace limitsurf
