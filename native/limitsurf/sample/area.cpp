// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_quadrature.h"
#include "limitsurf/sample/geometric_series.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {
namespace {

/// At first each patch is integrated until its error is this part of its area.
constexpr double kFirstTolerance = kAreaError / 10;
/// The patches with the largest errors are refined until the sum of all errors is this part of the
/// area.
constexpr double kTolerance = kAreaError / 4;
/// Refinement makes so many squares of all patches together, and at least so many of each patch
/// that it takes up.
constexpr int kMostSquares = 1 << 17, kFewSquares = 64;
/// The parts of a core may have this part of its tolerance each.
constexpr double kCoreShare = 4;
/// The last change of a core's extrapolated area may be this many times its tolerance: it is far
/// larger than the error that is left.
constexpr double kSeriesShare = 4;
/// After so many steps, the patches of a core are so flat that few points are enough for most.
constexpr int kFlatSteps = 4;
/// The number of tiles that one task integrates side by side.
constexpr std::size_t kTilesPerTask = 32;

/// How exactly a tile is to be integrated.
struct Effort {
  double relative, absolute;  ///< error: part of the area, or in units of area; the larger counts
};

void add(const SurfaceArea& part, SurfaceArea& sum) {
  sum.value += part.value;
  sum.error += part.error;
  sum.evaluations += part.evaluations;
}

/// The area of a core, which is a sequence of triples of patches towards the extraordinary vertex.
///
/// What is left after some steps is nearly flat, so that its area is hardly more than the length of
/// the integral of ds x dt over it. That integral is what the steps have left of the whole core's.
/// The sum of the steps' areas and this length approaches the area as a sum of geometric sequences,
/// so that the first steps tell its limit. Where the whole core's integral is not known, the sum of
/// the areas alone does so, more slowly.
class CoreSum {
 public:
  CoreSum(const SurfacePatches& patches, const SurfacePiece& core, const Effort& effort)
      : tolerance_(effort.absolute), step_{effort.relative, effort.absolute / kCoreShare} {
    is_rest_known_ = patches.coreNormal(core, rest_);
    if (is_rest_known_) {
      sum_.error = rest_.rounding;
      series_.add(rest_.normal.norm());
    }
  }

  /// How exactly the patches of the next step are to be integrated.
  const Effort& step() const { return step_; }

  /// Adds the three patches of a step, with the integral of ds x dt over them. Returns whether the
  /// rest needs no more steps.
  bool add(const SurfaceArea& area, const Vector3& normal) {
    limitsurf::add(area, sum_);
    rest_.normal -= normal;
    series_.add(sum_.value + (is_rest_known_ ? rest_.normal.norm() : 0));
    if (step_.relative > 0) {
      const double share = step_.relative * area.value;
      tolerance_ = std::max(tolerance_, kSeriesShare * share);
      step_ = {0, std::max(step_.absolute, share / kCoreShare)};
    }
    return series_.error() <= tolerance_ || !(area.value > 0);
  }

  SurfaceArea result() const {
    return {series_.limit(), sum_.error + series_.error(), sum_.evaluations};
  }

 private:
  double tolerance_;
  Effort step_;
  bool is_rest_known_;
  CoreNormal::Value rest_ = {Vector3::Zero(), 0};
  SurfaceArea sum_;
  GeometricSeries series_;
};

/// The areas of tiles. Their patches are integrated side by side: all regular ones and the first
/// patches of all cores, then the next patches of those cores that need more, and so on.
class TileAreas {
 public:
  explicit TileAreas(const SurfacePatches& patches) : patches_(patches) {}

  void measure(std::size_t begin, std::size_t end, double relative, SurfaceArea* areas) {
    cores_.clear();
    open_.clear();
    squares_.clear();
    tiles_.clear();
    for (std::size_t tile = begin; tile < end; ++tile) {
      areas[tile] = {};
      pieces_.clear();
      patches_.appendPieces(static_cast<int>(tile), pieces_);
      for (const SurfacePiece& piece : pieces_) {
        if (piece.isCore()) {
          open_.push_back(cores_.size());
          cores_.emplace_back(patches_, piece, relative);
        } else {
          squares_.emplace_back(patches_.patch(piece), relative, 0);
          tiles_.push_back(tile);
        }
      }
    }
    quadrature_.measure(squares_);
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      add(squares_[i].result(), areas[tiles_[i]]);
    }
    while (!open_.empty()) {
      measureStep(areas);
    }
  }

 private:
  struct Core {
    Core(const SurfacePatches& patches, const SurfacePiece& piece, double relative)
        : sum(patches, piece, Effort{relative, 0}) {
      split.core = piece;
    }

    CoreSum sum;
    SurfacePatches::SplitCore split;
  };

  /// Integrates the next patches of all cores, and finishes those that need no more.
  void measureStep(SurfaceArea* areas) {
    squares_.clear();
    for (const std::size_t i : open_) {
      Core& core = cores_[i];
      const SurfacePiece whole = core.split.core;
      patches_.splitPatches(whole, core.split);
      const Effort& effort = core.sum.step();
      for (const BezierPatch& patch : core.split.patches) {
        squares_.emplace_back(patch, effort.relative, effort.absolute);
      }
    }
    quadrature_.measure(squares_, cores_[open_.front()].split.core.steps >= kFlatSteps);
    std::size_t left = 0;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      SurfaceArea step;
      Vector3 normal = Vector3::Zero();
      for (std::size_t quarter = 0; quarter < 3; ++quarter) {
        const AreaSquare& square = squares_[3 * i + quarter];
        add(square.result(), step);
        normal += square.normal;
      }
      Core& core = cores_[open_[i]];
      const SurfacePiece& rest = core.split.core;
      if (core.sum.add(step, normal) || rest.steps >= SurfacePatches::kMostSteps) {
        areas[rest.tile] = core.sum.result();
      } else {
        open_[left++] = open_[i];
      }
    }
    open_.resize(left);
  }

  const SurfacePatches& patches_;
  AreaQuadrature quadrature_;
  std::vector<SurfacePiece> pieces_;
  std::vector<AreaSquare> squares_;
  std::vector<std::size_t> tiles_;  // of each square that is a regular patch
  std::vector<Core> cores_;
  std::vector<std::size_t> open_;  // the cores that need more steps
};

/// The area of a tile in which squares are quartered. At most `most_squares` are made.
SurfaceArea refinedArea(const SurfacePatches& patches, int tile, double tolerance,
                        int most_squares) {
  RefinedArea refined;
  std::vector<AreaSquare> squares;
  std::vector<SurfacePiece> pieces;
  patches.appendPieces(tile, pieces);
  if (!pieces.front().isCore()) {
    for (const SurfacePiece& piece : pieces) {
      squares.emplace_back(patches.patch(piece), 0, tolerance);
    }
    refined.start(squares);
    refined.refine(tolerance, most_squares);
    return refined.result();
  }
  CoreSum sum(patches, pieces.front(), {0, tolerance});
  SurfacePatches::SplitCore split;
  split.core = pieces.front();
  bool is_done = false;
  while (!is_done && split.core.steps < SurfacePatches::kMostSteps) {
    const SurfacePiece whole = split.core;
    patches.splitPatches(whole, split);
    squares.clear();
    for (const BezierPatch& patch : split.patches) {
      squares.emplace_back(patch, 0, sum.step().absolute);
    }
    refined.start(squares);
    refined.refine(sum.step().absolute, most_squares);
    is_done = sum.add(refined.result(), refined.normal());
    // The shares of later steps in the area fall by a factor of 4 or so.
    most_squares /= 2;
  }
  return sum.result();
}

SurfaceArea sumOf(const std::vector<SurfaceArea>& areas) {
  SurfaceArea sum;
  for (const SurfaceArea& area : areas) {
    add(area, sum);
  }
  return sum;
}

/// The tiles with the largest errors, as few as possible, without which the errors' sum is at most
/// `error`. Takes O(tiles) time.
std::vector<std::size_t> worstTiles(const std::vector<SurfaceArea>& areas, double error) {
  using Tile = std::pair<double, std::size_t>;  // its error and its number
  std::vector<Tile> tiles(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    tiles[i] = {areas[i].error, i};
  }
  // The first tile that is too much lies between these. Those before have errors of this sum.
  auto begin = tiles.begin(), end = tiles.end();
  double sum = 0;
  while (begin != end) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end);
    const double sum_to_middle =
        std::accumulate(begin, middle + 1, sum,
                        [](double before, const Tile& tile) { return before + tile.first; });
    if (sum_to_middle <= error) {
      begin = middle + 1;
      sum = sum_to_middle;
    } else {
      end = middle;
    }
  }
  std::vector<std::size_t> worst;
  worst.reserve(static_cast<std::size_t>(tiles.end() - begin));
  std::transform(begin, tiles.end(), std::back_inserter(worst),
                 [](const Tile& tile) { return tile.second; });
  std::sort(worst.begin(), worst.end());
  return worst;
}

}  // namespace

SurfaceArea measuredArea(const LimitSurface& surface, int threads) {
  checkThreads(threads);
  SurfacePatches patches(surface, threads, PatchUnit::own);
  patches.prepareCoreNormals();
  std::vector<SurfaceArea> areas(static_cast<std::size_t>(patches.tileCount()));
  parallelFor(areas.size(), kTilesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    TileAreas tiles(patches);
    for (; begin < end; begin += kTilesPerTask) {
      tiles.measure(begin, std::min(end, begin + kTilesPerTask), kFirstTolerance, areas.data());
    }
  });
  SurfaceArea sum = sumOf(areas);
  if (sum.error > kTolerance * sum.value) {
    const std::vector<std::size_t> worst = worstTiles(areas, kTolerance / 2 * sum.value);
    const int count = static_cast<int>(worst.size());
    const double tolerance = kTolerance / 2 * sum.value / count;
    const int squares = std::max(kFewSquares, kMostSquares / count);
    parallelFor(worst.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::int64_t before = areas[worst[i]].evaluations;
        areas[worst[i]] = refinedArea(patches, static_cast<int>(worst[i]), tolerance, squares);
        areas[worst[i]].evaluations += before;
      }
    });
    sum = sumOf(areas);
  }
  sum.value = sum.value / patches.scale() / patches.scale();
  sum.error = sum.error / patches.scale() / patches.scale();
  return sum;
}

double surfaceArea(const LimitSurface& surface, int threads) {
  return measuredArea(surface, threads).value;
}

}  // namespace limitsurf
