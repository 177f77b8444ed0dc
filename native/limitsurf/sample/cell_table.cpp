// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/cell_table.h"

#include <algorithm>
#include <utility>

#include "limitsurf/float_rounding.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The number of cells that one task finds the largest density of.
constexpr std::size_t kCellsPerTask = 1024;

}  // namespace

CellTable::CellTable(const std::vector<AreaCell>& cells, std::vector<float> largest)
    : largest_(std::move(largest)), sums_(cells.size()) {
  double sum = 0;
  InterruptionStride stride;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    stride.step();
    sum += cells[i].bound * this->largest(i);
    sums_[i] = sum;
  }
  first_.resize(cells.size() + 1);
  std::size_t cell = 0;
  for (std::size_t part = 0; part < first_.size(); ++part) {
    stride.step();
    const double end = static_cast<double>(part) / static_cast<double>(cells.size()) * sum;
    while (cell + 1 < cells.size() && sums_[cell] < end) {
      ++cell;
    }
    first_[part] = static_cast<std::uint32_t>(cell);
  }
}

CellTable::Choice CellTable::pick(double random) const {
  // Rounding must not lead to the very end, since the last cells may have no weight.
  const double at = std::min(random * total(), total() * (1 - 0x1p-52));
  // The search starts at the part that the number falls in, one part earlier because of rounding.
  const std::size_t part = static_cast<std::size_t>(random * static_cast<double>(sums_.size()));
  std::size_t cell = first_[part > 0 ? part - 1 : 0];
  while (cell + 1 < sums_.size() && sums_[cell] <= at) {
    ++cell;
  }
  const double before = cell == 0 ? 0 : sums_[cell - 1];
  const double rest = (at - before) / (sums_[cell] - before);
  return {cell, std::min(std::max(rest, 0.), 1 - 0x1p-53)};
}

std::vector<float> largestDensities(const SurfacePatches& patches,
                                    const std::vector<AreaCell>& cells, const DensityField& density,
                                    int threads) {
  std::vector<float> result;
  if (density.isConstant()) {
    return result;
  }
  result.resize(cells.size());
  parallelFor(cells.size(), kCellsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double largest = density.largestOn(rectangleOf(patches, cells[i]));
      result[i] = largest > 0 ? roundedUp(largest) : 0.f;
    }
  });
  return result;
}

}  // namespace limitsurf
