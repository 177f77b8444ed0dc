// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/dart_throwing.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/core_descent.h"
#include "limitsurf/sample/core_tail.h"
#include "limitsurf/sample/in_blocks.h"

namespace limitsurf {
namespace {

/// Cells that one thread takes at a time, and between two reports.
constexpr std::size_t kCellsPerTask = 1024, kCellsPerSlab = 64 * kCellsPerTask;
/// Cells begin with a reach of at most so many radii.
constexpr double kFirstReach = 1;
/// So many cells to begin with for each dart, and some, are too many: with good parameters it is
/// one.
constexpr double kMostCellsPerDart = 64, kSomeCells = 1 << 24;
/// A cell is cut one way alone if it is so many times as long as wide.
constexpr double kOblong = 1.5;

}  // namespace

/// What happens to cells. Keeps the patch of the last one: cells come sorted by patch.
class DartThrowing::Thrower {
 public:
  explicit Thrower(const DartThrowing& all) : all_(all) {}

  /// The cells to begin with on a piece.
  void begin(const SurfacePiece& piece, std::vector<DartCell>& cells) {
    DartCell cell;
    cell.piece = piece;
    if (piece.isCore()) {
      beginCore(cell, cells);
    } else {
      begin(cell, patchOf(cell), cells);
    }
  }

  void throwDart(const DartCell& cell, Outcome& out) {
    if (cell.piece.isCore()) {
      splitCore(cell, out.parts);
      return;
    }
    const BoundedPatch& patch = patchOf(cell);
    double smallest;
    if (!smallestRadius(patch.rectangle(cell), smallest)) {
      return;
    }
    const std::uint64_t bits =
        cell.bits(all_.key_ ^ mixed(static_cast<std::uint64_t>(all_.round_)));
    Proposal proposal;
    Dart& dart = proposal.dart;
    const double s = (cell.column + uniformIn01(mixed(bits))) * cell.width();
    const double t = (cell.row + uniformIn01(mixed(bits + 1))) * cell.height();
    patch.evaluate(s, t, dart.position, dart.normal);
    dart.at = patch.patch().on.at(s, t);
    const double area = length(dart.normal), weight = all_.density_.at(dart.at);
    if (patch.vanishes(area) || !(weight > 0)) {
      const CellExtent extent = patch.extent(cell);
      if (!patch.vanishes(extent)) {
        split(cell, extent, smallest, out.parts);
      }
      return;
    }
    dart.normal /= area;
    dart.radius = all_.radiusOf(weight);
    std::optional<CellExtent> extent;
    bool conflict = false;
    const bool covered = all_.accepted_.any(dart.position, dart.radius, [&](int other) {
      const Dart& disc = all_.darts_[other];
      if (!seeEachOther(disc.normal, dart.normal)) {
        return false;
      }
      conflict = true;
      if (!extent) {
        extent = patch.extent(cell);
      }
      return covers(disc, *extent, smallest);
    });
    if (covered) {
      return;
    }
    if (conflict) {
      split(cell, *extent, smallest, out.parts);
      return;
    }
    // As if darts fell on the whole surface one after the other: the first to arrive in a large
    // cell comes sooner.
    proposal.rank = uniformIn01(mixed(bits + 2)) * dart.radius * dart.radius /
                    (area * cell.width() * cell.height());
    proposal.cell = cell;
    out.proposals.push_back(proposal);
  }

  /// Whether the disc of the cell's own dart leaves nothing of it.
  bool covers(const Dart& disc, const DartCell& cell) {
    const BoundedPatch& patch = patchOf(cell);
    double smallest;
    return !smallestRadius(patch.rectangle(cell), smallest) ||
           covers(disc, patch.extent(cell), smallest);
  }

 private:
  const BoundedPatch& patchOf(const DartCell& cell) {
    const SurfacePiece& a = cell.piece;
    if (!patch_ || a.tile != piece_.tile || a.steps != piece_.steps || a.part != piece_.part) {
      piece_ = a;
      patch_.emplace(all_.patches_.patch(a));
    }
    return *patch_;
  }

  /// The smallest radius on a rectangle; false if nothing may be there.
  bool smallestRadius(const FaceRectangle& rectangle, double& radius) const {
    if (all_.density_.isConstant()) {
      radius = all_.radius_;
      return true;
    }
    const double weight = all_.density_.largestOn(rectangle);
    radius = all_.radiusOf(weight);
    return weight > 0;
  }

  static bool isCloser(const Dart& disc, const Vector3& middle, double reach, double smallest) {
    return length(Vector3(disc.position - middle)) + reach < (disc.radius + smallest) / 2;
  }
  static bool covers(const Dart& disc, const CellExtent& extent, double smallest) {
    return isCloser(disc, extent.middle, extent.reach, smallest) && extent.facesAll(disc.normal);
  }

  void split(const DartCell& cell, const CellExtent& extent, double smallest,
             std::vector<DartCell>& parts) const {
    if (2 * extent.reach <= all_.gap_ * smallest) {
      return;
    }
    bool along_s = !(extent.along_t > kOblong * extent.along_s);
    bool along_t = !(extent.along_s > kOblong * extent.along_t);
    along_s = along_s && cell.s_level < DartCell::kMostLevels;
    along_t = along_t && cell.t_level < DartCell::kMostLevels;
    if (!along_s && !along_t) {
      return;
    }
    for (unsigned t = 0; t < (along_t ? 2 : 1); ++t) {
      const DartCell strip = along_t ? cell.halfOfT(t) : cell;
      for (unsigned s = 0; s < (along_s ? 2 : 1); ++s) {
        parts.push_back(along_s ? strip.halfOfS(s) : strip);
      }
    }
  }

  void begin(const DartCell& cell, const BoundedPatch& patch, std::vector<DartCell>& cells) const {
    double smallest;
    if (!smallestRadius(patch.rectangle(cell), smallest)) {
      return;
    }
    const CellExtent extent = patch.extent(cell);
    if (extent.reach <= kFirstReach * smallest) {
      cells.push_back(cell);
      if (static_cast<double>(cells.size()) + static_cast<double>(all_.first_cells_) >
          all_.most_cells_) {
        throw std::invalid_argument(
            "faces are sheared or stretched so strongly that blue noise of this density would "
            "need more memory than its points are worth");
      }
      return;
    }
    std::vector<DartCell> parts;
    split(cell, extent, smallest, parts);
    for (const DartCell& part : parts) {
      begin(part, patch, cells);
    }
  }

  void beginCore(const DartCell& cell, std::vector<DartCell>& cells) const {
    double smallest;
    if (!smallestRadius(all_.patches_.rectangle(cell.piece), smallest)) {
      return;
    }
    if (cell.piece.steps < SurfacePatches::kMostSteps) {
      SurfacePatches::SplitCore parts;
      all_.patches_.split(cell.piece, parts);
      beginSplit(parts, smallest, cells);
    }
  }

  /// The patches of a split core, and its rest.
  void beginSplit(const SurfacePatches::SplitCore& split, double smallest,
                  std::vector<DartCell>& cells) const {
    DartCell cell;
    for (int quarter = 0; quarter < 3; ++quarter) {
      cell.piece = split.pieces[quarter];
      begin(cell, BoundedPatch(split.patches[quarter]), cells);
    }
    cell.piece = split.core;
    const double reach = CoreTail::farthest(all_.patches_.coreVertex(split.core), split.core_box);
    if (reach > kFirstReach * smallest) {
      beginCore(cell, cells);
    } else if (2 * reach > all_.gap_ * smallest) {
      cells.push_back(cell);
    }
  }

  void splitCore(const DartCell& cell, std::vector<DartCell>& parts) const {
    double smallest;
    if (cell.piece.steps >= SurfacePatches::kMostSteps ||
        !smallestRadius(all_.patches_.rectangle(cell.piece), smallest)) {
      return;
    }
    CoreDescent descent(all_.patches_, cell.piece, all_.gap_ * smallest);
    const bool covered = all_.accepted_.any(descent.vertex(), smallest, [&](int other) {
      const Dart& disc = all_.darts_[other];
      return isCloser(disc, descent.vertex(), descent.reach(), smallest) &&
             descent.facesAll(disc.normal);
    });
    if (!covered) {
      beginSplit(descent.firstSplit(), smallest, parts);
    }
  }

  const DartThrowing& all_;
  SurfacePiece piece_;
  std::optional<BoundedPatch> patch_;
};

DartThrowing::DartThrowing(const SurfacePatches& patches, const Box& box,
                           const DensityField& density, double radius, double gap, double expected,
                           std::uint64_t seed, int threads)
    : patches_(patches),
      density_(density),
      radius_(radius),
      // Beyond the surface's own size it makes no difference.
      largest_radius_(density.isConstant() ? radius : std::max(radius, 4 * patches.diagonal())),
      gap_(gap),
      most_cells_(kMostCellsPerDart * expected + kSomeCells),
      key_(mixed(seed)),
      threads_(threads),
      accepted_(box, radius_, largest_radius_),
      proposed_(box, radius_, largest_radius_) {}

double DartThrowing::radiusOf(double weight) const {
  return weight >= 1 ? radius_ : std::min(radius_ / std::sqrt(weight), largest_radius_);
}

std::vector<DartCell> DartThrowing::firstCells() {
  return concatenated<DartCell>(
      static_cast<std::size_t>(patches_.tileCount()), 64, threads_,
      [&](std::size_t begin, std::size_t end, std::vector<DartCell>& cells) {
        Thrower thrower(*this);
        std::vector<SurfacePiece> pieces;
        for (std::size_t tile = begin; tile < end; ++tile) {
          patches_.appendPieces(static_cast<int>(tile), pieces);
        }
        for (const SurfacePiece& piece : pieces) {
          const std::size_t before = cells.size();
          thrower.begin(piece, cells);
          // Counted piece by piece: one alone may have too many.
          first_cells_ += cells.size() - before;
        }
      });
}

void DartThrowing::run(const std::function<void(std::size_t darts)>& report) {
  cells_ = firstCells();
  for (; !cells_.empty(); ++round_) {
    std::vector<Proposal> proposals;
    std::vector<DartCell> parts;
    throwDarts(report, proposals, parts);
    accept(proposals, parts);
    cells_.swap(parts);
  }
}

void DartThrowing::throwDarts(const std::function<void(std::size_t)>& report,
                              std::vector<Proposal>& proposals,
                              std::vector<DartCell>& parts) const {
  for (std::size_t first = 0; first < cells_.size(); first += kCellsPerSlab) {
    report(darts_.size());
    const std::size_t count = std::min(kCellsPerSlab, cells_.size() - first);
    std::vector<Outcome> outcomes((count + kCellsPerTask - 1) / kCellsPerTask);
    parallelFor(outcomes.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t task = begin; task < end; ++task) {
        Thrower thrower(*this);
        const std::size_t last = std::min(count, (task + 1) * kCellsPerTask);
        for (std::size_t i = task * kCellsPerTask; i < last; ++i) {
          thrower.throwDart(cells_[first + i], outcomes[task]);
        }
      }
    });
    for (const Outcome& outcome : outcomes) {
      proposals.insert(proposals.end(), outcome.proposals.begin(), outcome.proposals.end());
      parts.insert(parts.end(), outcome.parts.begin(), outcome.parts.end());
    }
  }
}

void DartThrowing::accept(const std::vector<Proposal>& proposals, std::vector<DartCell>& open) {
  proposed_.clear();
  for (const Proposal& proposal : proposals) {
    proposed_.insert(proposal.dart.position, proposal.dart.radius);
  }
  enum Fate : char { kLost, kWon, kWonAll };
  std::vector<Fate> fates(proposals.size());
  parallelFor(proposals.size(), kCellsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
    Thrower thrower(*this);
    for (std::size_t i = begin; i < end; ++i) {
      const Proposal& own = proposals[i];
      const bool lost = proposed_.any(own.dart.position, own.dart.radius, [&](int number) {
        const std::size_t j = static_cast<std::size_t>(number);
        const Proposal& other = proposals[j];
        return (other.rank < own.rank || (other.rank == own.rank && j < i)) &&
               seeEachOther(other.dart.normal, own.dart.normal);
      });
      fates[i] = lost ? kLost : thrower.covers(own.dart, own.cell) ? kWonAll : kWon;
    }
  });
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    if (fates[i] != kLost) {
      const Dart& dart = proposals[i].dart;
      darts_.push_back(dart);
      accepted_.insert(dart.position, dart.radius);
    }
    if (fates[i] != kWonAll) {
      open.push_back(proposals[i].cell);
    }
  }
}

}  // namespace limitsurf
