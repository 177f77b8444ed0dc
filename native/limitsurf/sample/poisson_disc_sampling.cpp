// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/poisson_disc_sampling.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/concatenation.h"
#include "limitsurf/sample/core_descent.h"

namespace limitsurf {
namespace {

/// The number of cells that one task handles, and the number handled between two reports.
constexpr std::size_t kCellsPerTask = 1024, kCellsPerReport = 64 * kCellsPerTask;
/// The number of tiles that one task cuts into first cells.
constexpr std::size_t kTilesPerTask = 64;
/// The first cells have a reach of at most this many radii.
constexpr double kFirstReach = 1;
/// More first cells than kMostCellsPerPoint for each expected point, and kSpareCells besides, are
/// refused: with well-shaped parameters there is about one for each point.
constexpr double kMostCellsPerPoint = 64, kSpareCells = 1 << 24;
/// A cell more than this many times as long as wide is halved across its longer side only.
constexpr double kOblong = 1.5;

}  // namespace

/// The trials of cells. It keeps the patch of the last cell, because cells come sorted by patch.
class PoissonDiscSampling::CellTrials {
 public:
  explicit CellTrials(const PoissonDiscSampling& all) : all_(all), accepted_(all.accepted_) {}

  /// Appends the first cells of a piece.
  void begin(const SurfacePiece& piece, std::vector<TrialCell>& cells) {
    TrialCell cell;
    cell.piece = piece;
    if (piece.isCore()) {
      beginCore(cell, cells);
    } else {
      begin(cell, patchOf(cell), cells);
    }
  }

  /// Makes the trial of one cell: its outcome is a candidate, parts of the cell, or nothing if the
  /// cell is discarded.
  void makeTrial(const TrialCell& cell, Outcome& out) {
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
    Candidate candidate;
    NoisePoint& point = candidate.point;
    const double s = (cell.column + uniformIn01(mixed(bits))) * cell.width();
    const double t = (cell.row + uniformIn01(mixed(bits + 1))) * cell.height();
    patch.evaluate(s, t, point.position, point.normal);
    point.at = patch.patch().on.at(s, t);
    const double area = length(point.normal), weight = all_.density_.at(point.at);
    if (patch.vanishes(area) || !(weight > 0)) {
      const CellExtent extent = patch.extent(cell);
      if (!patch.vanishes(extent)) {
        accepted_.search(point.position);
        split(cell, extent, smallest, out.parts);
      }
      return;
    }
    point.normal /= area;
    point.radius = all_.radiusOf(weight);
    std::optional<CellExtent> extent;
    bool conflict = false;
    const bool covered = accepted_.any(point.position, point.radius, [&](int other) {
      const NoisePoint& disc = all_.points_[other];
      if (!seeEachOther(disc.normal, point.normal)) {
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
    // Ranks are the times at which candidates would arrive if points fell on the whole surface one
    // after the other: a large cell is hit sooner than a small one.
    candidate.rank = uniformIn01(mixed(bits + 2)) * point.radius * point.radius /
                     (area * cell.width() * cell.height());
    candidate.cell = cell;
    out.candidates.push_back(candidate);
  }

  /// Whether the disc of the cell's own point covers the whole cell.
  bool covers(const NoisePoint& disc, const TrialCell& cell) {
    const BoundedPatch& patch = patchOf(cell);
    double smallest;
    return !smallestRadius(patch.rectangle(cell), smallest) ||
           covers(disc, patch.extent(cell), smallest);
  }

 private:
  const BoundedPatch& patchOf(const TrialCell& cell) {
    const SurfacePiece& a = cell.piece;
    if (!patch_ || a.tile != piece_.tile || a.steps != piece_.steps || a.part != piece_.part) {
      piece_ = a;
      patch_.emplace(all_.patches_.patch(a));
    }
    return *patch_;
  }

  /// Computes the smallest radius on a rectangle. Returns false where the density is 0 throughout.
  bool smallestRadius(const FaceRectangle& rectangle, double& radius) const {
    if (all_.density_.isConstant()) {
      radius = all_.radius_;
      return true;
    }
    const double weight = all_.density_.largestOn(rectangle);
    radius = all_.radiusOf(weight);
    return weight > 0;
  }

  static bool isCloser(const NoisePoint& disc, const Vector3& middle, double reach,
                       double smallest) {
    return length(Vector3(disc.position - middle)) + reach < (disc.radius + smallest) / 2;
  }
  static bool covers(const NoisePoint& disc, const CellExtent& extent, double smallest) {
    return isCloser(disc, extent.middle, extent.reach, smallest) && extent.facesAll(disc.normal);
  }

  /// Appends the parts of a cell, but for those that a disc covers which the last search has met.
  void split(const TrialCell& cell, const CellExtent& extent, double smallest,
             std::vector<TrialCell>& parts) {
    if (2 * extent.reach <= all_.gap_ * smallest) {
      return;
    }
    bool along_s = !(extent.along_t > kOblong * extent.along_s);
    bool along_t = !(extent.along_s > kOblong * extent.along_t);
    along_s = along_s && cell.s_level < TrialCell::kMostLevels;
    along_t = along_t && cell.t_level < TrialCell::kMostLevels;
    if (!along_s && !along_t) {
      return;
    }
    const double s_part = along_s ? 0.5 : 0, t_part = along_t ? 0.5 : 0;
    const BezierPatch::Point s_off = s_part * extent.half_s, t_off = t_part * extent.half_t;
    const double reach =
        CellExtent::cornerReach((1 - s_part) * extent.half_s, (1 - t_part) * extent.half_t) +
        extent.bend;
    const auto isCovered = [&](unsigned s, unsigned t) {
      const BezierPatch::Point off = (s == 0 ? -1. : 1.) * s_off + (t == 0 ? -1. : 1.) * t_off;
      const Vector3 middle = extent.middle + off.head<3>().matrix();
      return accepted_.anyAgain(middle, smallest, [&](int other) {
        const NoisePoint& disc = all_.points_[other];
        return isCloser(disc, middle, reach, smallest) && extent.facesAll(disc.normal);
      });
    };
    for (unsigned t = 0; t < (along_t ? 2 : 1); ++t) {
      const TrialCell strip = along_t ? cell.halfOfT(t) : cell;
      for (unsigned s = 0; s < (along_s ? 2 : 1); ++s) {
        if (!isCovered(s, t)) {
          parts.push_back(along_s ? strip.halfOfS(s) : strip);
        }
      }
    }
  }

  void begin(const TrialCell& cell, const BoundedPatch& patch, std::vector<TrialCell>& cells) {
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
            "need far more memory than its points");
      }
      return;
    }
    std::vector<TrialCell> parts;
    split(cell, extent, smallest, parts);
    for (const TrialCell& part : parts) {
      begin(part, patch, cells);
    }
  }

  void beginCore(const TrialCell& cell, std::vector<TrialCell>& cells) {
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

  /// Appends the first cells of a split core: those of its patches, and those of the smaller core.
  void beginSplit(const SurfacePatches::SplitCore& split, double smallest,
                  std::vector<TrialCell>& cells) {
    TrialCell cell;
    for (int quarter = 0; quarter < 3; ++quarter) {
      cell.piece = split.pieces[quarter];
      begin(cell, BoundedPatch(split.patches[quarter]), cells);
    }
    cell.piece = split.core;
    const double reach = farthestDistance(all_.patches_.coreVertex(split.core), split.core_box);
    if (reach > kFirstReach * smallest) {
      beginCore(cell, cells);
    } else if (2 * reach > all_.gap_ * smallest) {
      cells.push_back(cell);
    }
  }

  void splitCore(const TrialCell& cell, std::vector<TrialCell>& parts) {
    double smallest;
    if (cell.piece.steps >= SurfacePatches::kMostSteps ||
        !smallestRadius(all_.patches_.rectangle(cell.piece), smallest)) {
      return;
    }
    CoreDescent descent(all_.patches_, cell.piece, all_.gap_ * smallest);
    const bool covered = accepted_.any(descent.vertex(), smallest, [&](int other) {
      const NoisePoint& disc = all_.points_[other];
      return isCloser(disc, descent.vertex(), descent.reach(), smallest) &&
             descent.facesAll(disc.normal);
    });
    if (!covered) {
      beginSplit(descent.firstSplit(), smallest, parts);
    }
  }

  const PoissonDiscSampling& all_;
  DiscGrid::Finder accepted_;
  SurfacePiece piece_;
  std::optional<BoundedPatch> patch_;
};

PoissonDiscSampling::PoissonDiscSampling(const SurfacePatches& patches, const Box& box,
                                         const DensityField& density, double radius, double gap,
                                         double expected, std::uint64_t seed, int threads)
    : patches_(patches),
      density_(density),
      radius_(radius),
      // A radius beyond the surface's own size makes no difference.
      largest_radius_(density.isConstant() ? radius : std::max(radius, 4 * patches.diagonal())),
      gap_(gap),
      most_cells_(kMostCellsPerPoint * expected + kSpareCells),
      key_(mixed(seed)),
      threads_(threads),
      accepted_(box, radius_, largest_radius_),
      candidates_(box, radius_, largest_radius_) {}

double PoissonDiscSampling::radiusOf(double weight) const {
  return weight >= 1 ? radius_ : std::min(radius_ / std::sqrt(weight), largest_radius_);
}

std::vector<TrialCell> PoissonDiscSampling::firstCells() {
  return concatenated<TrialCell>(
      static_cast<std::size_t>(patches_.tileCount()), kTilesPerTask, threads_,
      [&](std::size_t begin, std::size_t end, std::vector<TrialCell>& cells) {
        CellTrials trials(*this);
        std::vector<SurfacePiece> pieces;
        for (std::size_t tile = begin; tile < end; ++tile) {
          patches_.appendPieces(static_cast<int>(tile), pieces);
        }
        for (const SurfacePiece& piece : pieces) {
          const std::size_t before = cells.size();
          trials.begin(piece, cells);
          // Cells are counted after every piece, since a single piece may have too many.
          first_cells_ += cells.size() - before;
        }
      });
}

void PoissonDiscSampling::run(const std::function<void(std::size_t points)>& report) {
  cells_ = firstCells();
  for (; !cells_.empty(); ++round_) {
    std::vector<Candidate> candidates;
    std::vector<TrialCell> parts;
    makeTrials(report, candidates, parts);
    accept(candidates, parts);
    cells_.swap(parts);
  }
}

void PoissonDiscSampling::makeTrials(const std::function<void(std::size_t)>& report,
                                     std::vector<Candidate>& candidates,
                                     std::vector<TrialCell>& parts) const {
  for (std::size_t first = 0; first < cells_.size(); first += kCellsPerReport) {
    report(points_.size());
    const std::size_t count = std::min(kCellsPerReport, cells_.size() - first);
    std::vector<Outcome> outcomes((count + kCellsPerTask - 1) / kCellsPerTask);
    parallelFor(outcomes.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t task = begin; task < end; ++task) {
        CellTrials trials(*this);
        const std::size_t last = std::min(count, (task + 1) * kCellsPerTask);
        for (std::size_t i = task * kCellsPerTask; i < last; ++i) {
          trials.makeTrial(cells_[first + i], outcomes[task]);
        }
      }
    });
    for (const Outcome& outcome : outcomes) {
      candidates.insert(candidates.end(), outcome.candidates.begin(), outcome.candidates.end());
      parts.insert(parts.end(), outcome.parts.begin(), outcome.parts.end());
    }
  }
}

void PoissonDiscSampling::accept(const std::vector<Candidate>& candidates,
                                 std::vector<TrialCell>& open) {
  candidates_.clear();
  for (const Candidate& candidate : candidates) {
    candidates_.insert(candidate.point.position, candidate.point.radius);
  }
  enum Fate : char { kLost, kWon, kWonAll };
  std::vector<Fate> fates(candidates.size());
  parallelFor(candidates.size(), kCellsPerTask, threads_, [&](std::size_t begin, std::size_t end) {
    CellTrials trials(*this);
    DiscGrid::Finder others(candidates_);
    for (std::size_t i = begin; i < end; ++i) {
      const Candidate& own = candidates[i];
      const bool lost = others.any(own.point.position, own.point.radius, [&](int number) {
        const std::size_t j = static_cast<std::size_t>(number);
        const Candidate& other = candidates[j];
        return (other.rank < own.rank || (other.rank == own.rank && j < i)) &&
               seeEachOther(other.point.normal, own.point.normal);
      });
      fates[i] = lost ? kLost : trials.covers(own.point, own.cell) ? kWonAll : kWon;
    }
  });
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (fates[i] != kLost) {
      const NoisePoint& point = candidates[i].point;
      points_.push_back(point);
      accepted_.insert(point.position, point.radius);
    }
    if (fates[i] != kWonAll) {
      open.push_back(candidates[i].cell);
    }
  }
}

}  // namespace limitsurf
