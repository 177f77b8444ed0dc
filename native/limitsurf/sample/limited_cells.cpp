// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/limited_cells.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/float_rounding.h"
#include "limitsurf/sample/concatenation.h"

namespace limitsurf {
namespace {

struct LimitedCell {
  AreaCell cell;
  double largest;
};

/// The number of cells that one task splits.
constexpr std::size_t kCellsPerTask = 1024;

class CellSplitter {
 public:
  CellSplitter(const SurfacePatches& patches, const DensityLimits& limits,
               std::vector<LimitedCell>& out)
      : patches_(patches), limits_(limits), out_(out) {}

  void split(const AreaCell& cell) {
    stride_.step();
    const FaceRectangle rectangle = rectangleOf(patches_, cell);
    const auto [u0, u1, v0, v1] = rectangle.extent();
    const DensityLimits::Range range = limits_.on(rectangle.face, u0, u1, v0, v1);
    if (!(range.largest > 0)) {
      return;
    }
    if (cell.piece.isCore() || range.least == range.largest || isSmall(rectangle)) {
      out_.push_back({cell, range.largest});
      return;
    }
    AreaCell part = cell;
    part.level = static_cast<std::uint8_t>(cell.level + 1);
    // Bounds refer to the parameters of a cell itself, which cover a quarter of the area now.
    part.bound = cell.bound / 4;
    part.area = cell.area / 4;
    part.least = cell.least / 4;
    for (int quarter = 0; quarter < 4; ++quarter) {
      part.column = static_cast<std::uint16_t>(2 * cell.column + (quarter & 1));
      part.row = static_cast<std::uint16_t>(2 * cell.row + (quarter >> 1));
      split(part);
    }
  }

 private:
  /// Whether the rectangle is no longer than a square on either side. (A strip along a semi-sharp
  /// edge may lie across the borders of squares and still be small.)
  bool isSmall(const FaceRectangle& rectangle) const {
    const double square = 1. / limits_.side();
    return std::abs(rectangle.us) + std::abs(rectangle.ut) <= square &&
           std::abs(rectangle.vs) + std::abs(rectangle.vt) <= square;
  }

  const SurfacePatches& patches_;
  const DensityLimits& limits_;
  std::vector<LimitedCell>& out_;
  InterruptionStride stride_;
};

}  // namespace

LimitedCells limitedCells(const SurfacePatches& patches, const std::vector<AreaCell>& cells,
                          const DensityLimits& limits, int threads) {
  const std::vector<LimitedCell> found = concatenated<LimitedCell>(
      cells.size(), kCellsPerTask, threads,
      [&](std::size_t begin, std::size_t end, std::vector<LimitedCell>& out) {
        CellSplitter splitter(patches, limits, out);
        for (std::size_t i = begin; i < end; ++i) {
          splitter.split(cells[i]);
        }
      });
  LimitedCells result;
  result.cells.reserve(found.size());
  result.largest.reserve(found.size());
  InterruptionStride stride;
  for (const LimitedCell& cell : found) {
    stride.step();
    result.unit = std::max(result.unit, cell.largest);
  }
  for (const LimitedCell& cell : found) {
    stride.step();
    result.cells.push_back(cell.cell);
    result.largest.push_back(roundedUp(cell.largest / result.unit));
  }
  return result;
}

}  // namespace limitsurf
