// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area_cells.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

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
/// A number in double precision that is multiplied with this does not grow when it is rounded to
/// single precision.
constexpr double kRoundedDown = 1 - 0x1p-22;
/// The points of a patch are right to this part of the surface's diagonal, products to this part of
/// themselves. More than what was seen, and less than kPositionError.
constexpr double kPointRounding = 0x1p-48;
/// The number of tiles that one task cuts into cells.
constexpr std::size_t kTilesPerTask = 64;

/// Cuts tiles into cells. Patches are bounded side by side: all regular ones and the first patches
/// of all cores, then the next patches of those cores that need more, and so on.
class CellMaker {
 public:
  explicit CellMaker(const SurfacePatches& patches) : patches_(patches) {}

  /// Appends the cells of some tiles, in the order of the tiles' pieces.
  void cut(std::size_t begin, std::size_t end, std::vector<AreaCell>& cells) {
    pieces_.clear();
    for (std::size_t tile = begin; tile < end; ++tile) {
      patches_.appendPieces(static_cast<int>(tile), pieces_);
    }
    found_.clear();
    counts_.assign(pieces_.size() + 1, 0);
    cores_.clear();
    cores_.reserve(pieces_.size());
    open_.clear();
    for (std::size_t place = 0; place < pieces_.size(); ++place) {
      const SurfacePiece& piece = pieces_[place];
      if (piece.isCore()) {
        open_.push_back(cores_.size());
        cores_.emplace_back(patches_, piece, place);
      } else {
        wait(piece, patches_.patch(piece), place, kNoCore);
      }
    }
    do {
      splitCores();
      addWaiting();
      finishCores();
    } while (!open_.empty());
    appendInOrder(cells);
  }

 private:
  static constexpr std::size_t kNoCore = static_cast<std::size_t>(-1);

  struct Core {
    Core(const SurfacePatches& patches, const SurfacePiece& piece, std::size_t in_order)
        : rest(piece), place(in_order), pitches(patches, piece) {}

    SurfacePiece rest;
    std::size_t place;  // of the piece in its order
    RingPitches pitches;
    SurfacePatches::SplitCore split;
    double bounds = 0, last = 0;  // of all patches so far, and the area of those of the last step
    double sum = 0, area = 0;     // of the cells of this step: all bounds, and the whole area
  };
  /// A patch that waits.
  struct Waiting {
    SurfacePiece piece;
    std::size_t place, core;
  };

  /// Patches wait until there are enough to be bounded side by side.
  void wait(const SurfacePiece& piece, const BezierPatch& patch, std::size_t place,
            std::size_t core) {
    waiting_[count_] = {piece, place, core};
    block_.put(patch, count_);
    if (++count_ == SquareBlock::kCount) {
      addWaiting();
    }
  }

  /// Adds the cells of all patches that wait.
  void addWaiting() {
    double bounds[SquareBlock::kCount], means[SquareBlock::kCount], least[SquareBlock::kCount];
    for (int place = count_; count_ > 0 && place < SquareBlock::kCount; ++place) {
      block_.copy(0, place);
    }
    AreaKernels::get().bounds(block_, count_, bounds, means, least);
    for (int i = 0; i < count_; ++i) {
      AreaCell cell;
      cell.piece = waiting_[i].piece;
      now_ = &waiting_[i];
      if (isLoose(bounds[i], means[i])) {
        BezierPatch patch;
        block_.get(i, patch);
        const AreaForm form(patch);
        addCell(cell, form, 1, form.mean());
      } else {
        cell.least = least[i] > 0 ? static_cast<float>(kRoundedDown * least[i]) : 0;
        addCell(cell, bounds[i], means[i]);
      }
    }
    count_ = 0;
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
      if (now_->core != kNoCore) {
        cores_[now_->core].sum += cell.bound;
        cores_[now_->core].area += cell.area;
      }
      add(cell, now_->place);
    }
  }

  void add(const AreaCell& cell, std::size_t place) {
    found_.emplace_back(place, cell);
    ++counts_[place + 1];
  }

  /// Splits all open cores once.
  void splitCores() {
    for (const std::size_t i : open_) {
      Core& core = cores_[i];
      core.sum = core.area = 0;
      const SurfacePiece whole = core.rest;
      patches_.splitPatches(whole, core.split);
      core.rest = core.split.core;
      for (int quarter = 0; quarter < 3; ++quarter) {
        wait(core.split.pieces[quarter], core.split.patches[quarter], core.place, i);
      }
    }
  }

  /// Adds the rests of cores that need no more steps.
  void finishCores() {
    std::size_t left = 0;
    for (const std::size_t i : open_) {
      if (!finish(cores_[i])) {
        open_[left++] = i;
      }
    }
    open_.resize(left);
  }

  bool finish(Core& core) {
    const double before = core.last;
    core.bounds += core.sum;
    core.last = core.area;
    const int steps = core.rest.steps;
    const Vector3 outer = patches_.outerPitch(core.split, core.pitches.frame());
    AreaCell cell;
    cell.piece = core.rest;
    // The bound is summed up from the rounded numbers, as samplers will do it, to the last bit.
    Vector3 rounded;
    for (int axis = 0; axis < 3; ++axis) {
      rounded[axis] = cell.outer[axis] = roundedUp(outer[axis]);
    }
    const double most = kTail * core.bounds;
    const double area = CoreTail(core.pitches, steps, rounded).area(most);
    if (area > most) {
      return steps >= SurfacePatches::kMostSteps;
    }
    if (area > 0) {
      cell.bound = roundedUp(area);
      // The areas of further steps shrink by about the same factor.
      const double factor = before > 0 ? std::min(core.last / before, kSlowest) : kUsual;
      cell.area = std::min(cell.bound, static_cast<float>(core.last * factor / (1 - factor)));
      add(cell, core.place);
    }
    return true;
  }

  /// The cells of a piece stay in the order in which they were found.
  void appendInOrder(std::vector<AreaCell>& cells) {
    std::partial_sum(counts_.begin(), counts_.end(), counts_.begin());
    const std::size_t first = cells.size();
    cells.resize(first + found_.size());
    for (const auto& [place, cell] : found_) {
      cells[first + counts_[place]++] = cell;
    }
  }

  const SurfacePatches& patches_;
  std::vector<SurfacePiece> pieces_;
  std::vector<Core> cores_;
  std::vector<std::size_t> open_;  // the cores that need more steps
  SquareBlock block_;
  Waiting waiting_[SquareBlock::kCount];
  int count_ = 0;                                        // of those that wait
  const Waiting* now_ = nullptr;                         // the one whose cells are added
  std::vector<std::pair<std::size_t, AreaCell>> found_;  // with the places of their pieces
  std::vector<std::size_t> counts_;                      // of the cells of the piece before
};

/// The largest step between control points along s or t.
double longestStep(const BezierPatch& patch, bool along_t) {
  const int step = along_t ? 4 : 1, across = along_t ? 1 : 4;
  double longest = 0;
  for (int line = 0; line < 4; ++line) {
    const BezierPatch::Point* p = patch.points + across * line;
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, length(BezierPatch::Point(p[step * (i + 1)] - p[step * i])));
    }
  }
  return longest;
}

/// `diagonal`: of the whole surface.
bool hasArea(const BezierPatch& patch, double diagonal) {
  const double along_s = 3 * longestStep(patch, false), along_t = 3 * longestStep(patch, true);
  return AreaForm(patch).bound() >
         kPointRounding * (diagonal * (along_s + along_t) + along_s * along_t);
}

/// Whether any patch has area. Of a core only the first three are looked at: the others are
/// made of the same control points.
bool hasArea(const SurfacePatches& patches) {
  const double diagonal = patches.diagonal();
  std::vector<SurfacePiece> pieces;
  SurfacePatches::SplitCore split;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    for (const SurfacePiece& piece : pieces) {
      if (!piece.isCore()) {
        if (hasArea(patches.patch(piece), diagonal)) {
          return true;
        }
        continue;
      }
      patches.splitPatches(piece, split);
      for (const BezierPatch& patch : split.patches) {
        if (hasArea(patch, diagonal)) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace

std::vector<AreaCell> areaCells(const SurfacePatches& patches, int threads) {
  if (!hasArea(patches)) {
    return {};
  }
  const std::size_t tiles = static_cast<std::size_t>(patches.tileCount());
  return concatenated<AreaCell>(
      tiles, kTilesPerTask, threads,
      [&](std::size_t begin, std::size_t end, std::vector<AreaCell>& cells) {
        CellMaker(patches).cut(begin, end, cells);
      });
}

FaceRectangle rectangleOf(const SurfacePatches& patches, const AreaCell& cell) {
  const FaceRectangle whole = patches.rectangle(cell.piece);
  const double size = 1. / (1 << cell.level);
  return whole.part(cell.column * size, cell.row * size, size, size);
}

}  // namespace limitsurf
