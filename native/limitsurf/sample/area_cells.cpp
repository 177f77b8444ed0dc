// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_cells.h"

#include "limitsurf/float_rounding.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/concatenation.h"
#include "limitsurf/sample/core_tail.h"

namespace limitsurf {
namespace {

/// A cell is split while its bound exceeds kLoose times its area and the difference is more than
/// kNoticeable of the patch's area, at most kMostLevels times. Chosen for speed: loose bounds cost
/// rejected samples, more cells cost memory.
constexpr double kLoose = 1.3, kNoticeable = 0.02;
constexpr int kMostLevels = 6;
/// A core is split until the bound on its area is this part of the bounds of the patches around it.
constexpr double kTail = 0.05;
/// The number of tiles that one task cuts into cells.
constexpr std::size_t kTilesPerTask = 64;

/// Cuts pieces of the surface into cells.
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

  /// `size` is the part of the patch's parameter square that the cell covers, `whole` the patch's
  /// area.
  void addCell(AreaCell cell, const AreaForm& form, double size, double whole) {
    const double bound = form.bound(), mean = form.mean();
    if (cell.level < kMostLevels && bound > kLoose * mean &&
        (bound - mean) * size > kNoticeable * whole) {
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
          // The bound is summed up from the rounded number, as samplers will do it, to the last
          // bit.
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
  double bounds_ = 0;  // the sum of the bounds of a core's cells so far
};

}  // namespace

std::vector<AreaCell> areaCells(const SurfacePatches& patches, int threads) {
  const std::size_t tiles = static_cast<std::size_t>(patches.tileCount());
  return concatenated<AreaCell>(
      tiles, kTilesPerTask, threads,
      [&](std::size_t begin, std::size_t end, std::vector<AreaCell>& cells) {
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

}  // namespace limitsurf
