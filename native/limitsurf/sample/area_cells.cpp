// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_cells.h"

#include <algorithm>

#include "limitsurf/float_rounding.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/area_kernels.h"
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
constexpr double kTail = 0.25;
/// By what the areas of a core's steps shrink at least, for an estimate, and by what they do around
/// a regular vertex.
constexpr double kSlowest = 0.5, kUsual = 0.25;
/// The number of tiles that one task cuts into cells.
constexpr std::size_t kTilesPerTask = 64;

/// Cuts pieces of the surface into cells.
class CellMaker {
 public:
  CellMaker(const SurfacePatches& patches, std::vector<AreaCell>& cells)
      : patches_(patches), cells_(cells) {}
  ~CellMaker() { addWaiting(); }

  void add(const SurfacePiece& piece) {
    if (piece.isCore()) {
      addWaiting();
      addCore(piece);
    } else {
      wait(piece, patches_.patch(piece));
    }
  }

 private:
  /// Patches wait until there are enough to be bounded side by side.
  void wait(const SurfacePiece& piece, const BezierPatch& patch) {
    pieces_[waiting_] = piece;
    block_.put(patch, waiting_);
    if (++waiting_ == SquareBlock::kCount) {
      addWaiting();
    }
  }

  /// Adds the cells of all patches that wait. Returns the sum of their bounds.
  double addWaiting() {
    double bounds[SquareBlock::kCount], means[SquareBlock::kCount];
    for (int place = waiting_; waiting_ > 0 && place < SquareBlock::kCount; ++place) {
      block_.copy(0, place);
    }
    AreaKernels::get().bounds(block_, waiting_, bounds, means);
    sum_ = area_ = 0;
    for (int i = 0; i < waiting_; ++i) {
      AreaCell cell;
      cell.piece = pieces_[i];
      if (isLoose(bounds[i], means[i])) {
        BezierPatch patch;
        block_.get(i, patch);
        const AreaForm form(patch);
        addCell(cell, form, 1, form.mean());
      } else {
        addCell(cell, bounds[i], means[i]);
      }
    }
    waiting_ = 0;
    return sum_;
  }

  static bool isLoose(double bound, double mean) { return bound > kLoose * mean; }

  /// `size` is the part of the patch's parameter square that the cell covers, `whole` the patch's
  /// area.
  void addCell(AreaCell cell, const AreaForm& form, double size, double whole) {
    const double bound = form.bound(), mean = form.mean();
    if (cell.level < kMostLevels && isLoose(bound, mean) &&
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
    addCell(cell, bound * size, mean * size);
  }

  void addCell(AreaCell& cell, double bound, double area) {
    if (bound > 0) {
      cell.bound = roundedUp(bound);
      cell.area = static_cast<float>(area);
      sum_ += cell.bound;
      area_ += cell.area;
      cells_.push_back(cell);
    }
  }

  void addCore(SurfacePiece core) {
    double bounds = 0, last = 0;
    SurfacePatches::SplitCore split;
    RingPitches pitches(patches_, core);
    while (core.steps < SurfacePatches::kMostSteps) {
      patches_.split(core, split);
      for (int quarter = 0; quarter < 3; ++quarter) {
        wait(split.pieces[quarter], split.patches[quarter]);
      }
      const double before = last;
      bounds += addWaiting();
      last = area_;
      core = split.core;
      const Vector3 outer = patches_.outerPitch(split, pitches.frame());
      const double area = CoreTail(pitches, core.steps, outer).area();
      if (!(area > kTail * bounds)) {
        if (!(area > 0)) {
          return;
        }
        AreaCell cell;
        cell.piece = core;
        // The bound is summed up from the rounded numbers, as samplers will do it, to the last bit.
        Vector3 rounded;
        for (int axis = 0; axis < 3; ++axis) {
          rounded[axis] = cell.outer[axis] = roundedUp(outer[axis]);
        }
        cell.bound = roundedUp(CoreTail(pitches, core.steps, rounded).area());
        // The areas of further steps shrink by about the same factor.
        const double factor = before > 0 ? std::min(last / before, kSlowest) : kUsual;
        cell.area = std::min(cell.bound, static_cast<float>(last * factor / (1 - factor)));
        cells_.push_back(cell);
        return;
      }
    }
  }

  const SurfacePatches& patches_;
  std::vector<AreaCell>& cells_;
  SquareBlock block_;
  SurfacePiece pieces_[SquareBlock::kCount];
  int waiting_ = 0;
  double sum_ = 0, area_ = 0;  // of the cells made together: all bounds, and the whole area
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
