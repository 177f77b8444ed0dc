// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_cells.h"

#include <algorithm>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/core_tail.h"
#include "limitsurf/sample/in_blocks.h"

namespace limitsurf {
namespace {

/// A cell is cut while its bound is so many times its area, and the difference counts on the patch.
constexpr double kLoose = 1.3, kCounts = 0.02;
constexpr int kMostLevels = 6;
/// A core is split until the bound on its area is this part of that of the patches around it.
constexpr double kTail = 0.05;

/// The next float that is not below.
float roundedUp(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

class CellMaker {
 public:
  CellMaker(const SurfacePatches& patches, std::vector<AreaCell>& cells)
      : patches_(patches), cells_(cells) {}

  void add(const SurfacePiece& piece) {
    if (piece.isCore()) {
      addCore(piece);
    } else {
      addPatch(piece, patches_.patch(piece));
    }
  }

 private:
  void addPatch(const SurfacePiece& piece, const BezierPatch& patch) {
    const AreaForm form(patch);
    AreaCell cell;
    cell.piece = piece;
    addCell(cell, form, 1, form.mean());
  }

  /// `size`: the cell's part of the patch's (s, t), `whole`: the patch's area.
  void addCell(AreaCell cell, const AreaForm& form, double size, double whole) {
    const double bound = form.bound(), mean = form.mean();
    if (cell.level < kMostLevels && bound > kLoose * mean &&
        (bound - mean) * size > kCounts * whole) {
      for (int t = 0; t < 2; ++t) {
        const AreaForm strip = form.half(true, t);
        for (int s = 0; s < 2; ++s) {
          AreaCell part = cell;
          part.level = static_cast<std::uint8_t>(cell.level + 1);
          part.column = static_cast<std::uint16_t>(2 * cell.column + s);
          part.row = static_cast<std::uint16_t>(2 * cell.row + t);
          addCell(part, strip.half(false, s), size / 4, whole);
        }
      }
      return;
    }
    if (bound > 0) {
      cell.bound = roundedUp(bound * size);
      cell.area = static_cast<float>(mean * size);
      bounds_ += cell.bound;
      cells_.push_back(cell);
    }
  }

  void addCore(SurfacePiece core) {
    bounds_ = 0;
    SurfacePatches::SplitCore split;
    while (core.steps < SurfacePatches::kMostSteps) {
      patches_.split(core, split);
      for (int quarter = 0; quarter < 3; ++quarter) {
        addPatch(split.pieces[quarter], split.patches[quarter]);
      }
      core = split.core;
      const CoreTail tail(patches_, core, split.core_box);
      const double area = tail.area();
      if (!(area > kTail * bounds_)) {
        if (area > 0) {
          AreaCell cell;
          cell.piece = core;
          // Summed up again from the rounded number, to the last bit as CoreTail will do it.
          cell.outer = roundedUp(tail.outer());
          cell.bound = roundedUp(CoreTail(patches_, core, cell.outer).area());
          cells_.push_back(cell);
        }
        return;
      }
    }
  }

  const SurfacePatches& patches_;
  std::vector<AreaCell>& cells_;
  double bounds_ = 0;  // of the cells of a core so far
};

}  // namespace

std::vector<AreaCell> areaCells(const SurfacePatches& patches, int threads) {
  const std::size_t tiles = static_cast<std::size_t>(patches.tileCount());
  return concatenated<AreaCell>(
      tiles, 64, threads, [&](std::size_t begin, std::size_t end, std::vector<AreaCell>& cells) {
        CellMaker maker(patches, cells);
        std::vector<SurfacePiece> pieces;
        for (std::size_t tile = begin; tile < end; ++tile) {
          pieces.clear();
          patches.appendPieces(static_cast<int>(tile), pieces);
          for (const SurfacePiece& piece : pieces) {
            maker.add(piece);
          }
        }
      });
}

FaceRectangle rectangleOf(const SurfacePatches& patches, const AreaCell& cell) {
  const FaceRectangle whole = patches.rectangle(cell.piece);
  const double size = 1. / (1 << cell.level);
  return whole.part(cell.column * size, cell.row * size, size, size);
}

CellTable::CellTable(const SurfacePatches& patches, const std::vector<AreaCell>& cells,
                     const DensityField& density, int threads)
    : sums_(cells.size()) {
  if (!density.isConstant()) {
    largest_.resize(cells.size());
    parallelFor(cells.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double largest = density.largestOn(rectangleOf(patches, cells[i]));
        largest_[i] = largest > 0 ? roundedUp(largest) : 0.f;
      }
    });
  }
  double sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    sum += cells[i].bound * largest(i);
    sums_[i] = sum;
  }
  first_.resize(cells.size() + 1);
  std::size_t cell = 0;
  for (std::size_t part = 0; part < first_.size(); ++part) {
    const double end = static_cast<double>(part) / static_cast<double>(cells.size()) * sum;
    while (cell + 1 < cells.size() && sums_[cell] < end) {
      ++cell;
    }
    first_[part] = static_cast<std::uint32_t>(cell);
  }
}

CellTable::Choice CellTable::pick(double random) const {
  // Rounding must not reach the end: the last cells may weigh nothing.
  const double at = std::min(random * total(), total() * (1 - 0x1p-52));
  // The part that begins at or before it, with a step back for rounding.
  const std::size_t part = static_cast<std::size_t>(random * static_cast<double>(sums_.size()));
  std::size_t cell = first_[part > 0 ? part - 1 : 0];
  while (cell + 1 < sums_.size() && sums_[cell] <= at) {
    ++cell;
  }
  const double before = cell == 0 ? 0 : sums_[cell - 1];
  const double rest = (at - before) / (sums_[cell] - before);
  return {cell, std::min(std::max(rest, 0.), 1 - 0x1p-53)};
}

}  // namespace limitsurf
