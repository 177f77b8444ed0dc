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
    double smallest;
    if (isEmpty(cell, smallest)) {
      return;
    }
    const std::uint64_t bits =
        cell.bits(all_.key_ ^ mixed(static_cast<std::uint64_t>(all_.round_)));
    const double s = uniformIn01(mixed(bits)), t = uniformIn01(mixed(bits + 1));
    Candidate candidate;
    NoisePoint& point = candidate.point;
    // |ds x dt| of the cell's own parameters.
    const double area =
        cell.piece.isCore() ? findInCore(cell.piece, s, t, point) : findInPatch(cell, s, t, point);
    const double weight = all_.density_.at(point.at);
    extent_.reset();
    descent_.reset();
    if (!(area > 0 && weight > 0)) {
      accepted_.search(point.position);
      split(cell, smallest, out.parts);
      return;
    }
    point.normal /= length(point.normal);
    point.radius = all_.radiusOf(weight);
    bool conflict = false;
    const bool covered = accepted_.any(point.position, point.radius, [&](int other) {
      const NoisePoint& disc = all_.points_[other];
      if (!seeEachOther(disc.normal, point.normal)) {
        return false;
      }
      conflict = true;
      return covers(disc, cell, smallest);
    });
    if (covered) {
      return;
    }
    if (conflict) {
      split(cell, smallest, out.parts);
      return;
    }
    // Ranks are the times at which candidates would arrive if points fell on the whole surface one
    // after the other: a large cell is hit sooner than a small one.
    candidate.rank = uniformIn01(mixed(bits + 2)) * point.radius * point.radius / area;
    candidate.cell = cell;
    out.candidates.push_back(candidate);
  }

  /// Whether the disc of the cell's own point covers the whole cell.
  bool coversAll(const NoisePoint& disc, const TrialCell& cell) {
    double smallest;
    extent_.reset();
    descent_.reset();
    return isEmpty(cell, smallest) || covers(disc, cell, smallest);
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

  /// Whether the cell has no room for points. If not, computes the smallest radius in it.
  bool isEmpty(const TrialCell& cell, double& smallest) {
    if (!cell.piece.isCore()) {
      return !smallestRadius(patchOf(cell).rectangle(cell), smallest);
    }
    return cell.piece.steps >= SurfacePatches::kMostSteps ||
           !smallestRadius(all_.patches_.rectangle(cell.piece), smallest);
  }

  /// Sets the position, normal and location of a point at (s, t) of the cell. The normal is ds x dt
  /// of the patch. Returns its length with respect to the cell, or 0 if it vanishes.
  double findInPatch(const TrialCell& cell, double s, double t, NoisePoint& point) {
    const BoundedPatch& patch = patchOf(cell);
    s = (cell.column + s) * cell.width();
    t = (cell.row + t) * cell.height();
    patch.evaluate(s, t, point.position, point.normal);
    point.at = patch.patch().on.at(s, t);
    const double area = length(point.normal);
    return patch.vanishes(area) ? 0 : area * cell.width() * cell.height();
  }
  double findInCore(const SurfacePiece& core, double s, double t, NoisePoint& point) const {
    SurfacePiece piece = core;
    double size = 1;
    do {
      ++piece.steps;
      size /= 2;
      s *= 2;
      t *= 2;
    } while (std::max(s, t) < 1 && piece.steps < SurfacePatches::kMostSteps);
    const bool right = s >= 1, top = t >= 1;
    piece.part = static_cast<std::int16_t>(right && top ? 1 : top ? 2 : 0);
    const BezierPatch patch = all_.patches_.patch(piece);
    BezierPatch::Values values;
    s = std::clamp(piece.part == 2 ? s : s - 1, 0., 1.);
    t = std::clamp(piece.part == 0 ? t : t - 1, 0., 1.);
    patch.evaluate<1>(s, t, values);
    point.position = (values.value + patch.anchor).head<3>().matrix();
    point.normal = cross(values.ds, values.dt);
    point.at = patch.on.at(s, t);
    const double area = length(point.normal);
    const bool vanishes =
        !(area > BoundedPatch::kCrossRounding * length(values.ds) * length(values.dt));
    return vanishes ? 0 : area / (size * size);
  }

  static bool isCloser(const NoisePoint& disc, const Vector3& middle, double reach,
                       double smallest) {
    return length(Vector3(disc.position - middle)) + reach < (disc.radius + smallest) / 2;
  }
  static bool covers(const NoisePoint& disc, const CellExtent& extent, double smallest) {
    return isCloser(disc, extent.middle, extent.reach, smallest) && extent.facesAll(disc.normal);
  }
  /// Whether a disc covers the cell that is being tried.
  bool covers(const NoisePoint& disc, const TrialCell& cell, double smallest) {
    if (!cell.piece.isCore()) {
      return covers(disc, extentOf(cell), smallest);
    }
    const CoreExtent& extent = coreExtentOf(cell, smallest);
    return isCloser(disc, extent.middle, extent.reach, smallest) &&
           (extent.cone.isFacedBy(disc.normal) || descentOf(cell, smallest).facesAll(disc.normal));
  }

  const CellExtent& extentOf(const TrialCell& cell) {
    if (!extent_) {
      extent_ = patchOf(cell).extent(cell);
    }
    return *extent_;
  }
  CoreDescent& descentOf(const TrialCell& cell, double smallest) {
    if (!descent_) {
      descent_.emplace(all_.patches_, cell.piece, all_.gap_ * smallest);
    }
    return *descent_;
  }
  const CoreExtent& coreExtentOf(const TrialCell& cell, double smallest) {
    CoreExtent& extent = all_.cores_[static_cast<std::size_t>(cell.piece.tile)];
    if (extent.steps != cell.piece.steps) {
      CoreDescent& descent = descentOf(cell, smallest);
      // The cone of a larger core serves the smaller ones in it as well.
      if (!extent.cone.isKnown()) {
        extent.cone = descent.cone();
      }
      descent.findReach();
      extent.steps = cell.piece.steps;
      extent.middle = descent.middle();
      extent.reach = descent.reach();
    }
    return extent;
  }

  /// Appends the parts of the cell that is being tried.
  void split(const TrialCell& cell, double smallest, std::vector<TrialCell>& parts) {
    if (cell.piece.isCore()) {
      beginSplit(descentOf(cell, smallest).firstSplit(), smallest, parts);
    } else if (!patchOf(cell).vanishes(extentOf(cell))) {
      split(cell, extentOf(cell), smallest, parts);
    }
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
    if (accepted_.anyAgain(extent.middle, smallest, [&](int other) {
          return covers(all_.points_[other], extent, smallest);
        })) {
      return;
    }
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
    if (isEmpty(cell, smallest)) {
      return;
    }
    descent_.reset();
    if (coreExtentOf(cell, smallest).reach <= kFirstReach * smallest) {
      cells.push_back(cell);
      return;
    }
    const SurfacePatches::SplitCore split = descentOf(cell, smallest).firstSplit();
    beginSplit(split, smallest, cells);
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

  const PoissonDiscSampling& all_;
  DiscGrid::Finder accepted_;
  SurfacePiece piece_;
  std::optional<BoundedPatch> patch_;
  // Of the cell that is being tried, once they are needed.
  std::optional<CellExtent> extent_;
  std::optional<CoreDescent> descent_;
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
      cores_(static_cast<std::size_t>(patches.tileCount())),
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
    trials_ += cells_.size();
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
      fates[i] = lost ? kLost : trials.coversAll(own.point, own.cell) ? kWonAll : kWon;
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
