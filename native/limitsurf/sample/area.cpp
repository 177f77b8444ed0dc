// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/sample/area_quadrature.h"
#include "limitsurf/sample/geometric_series.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {
namespace {

/// At first each patch is integrated until its error is this part of its area.
constexpr double kFirstTolerance = kAreaError / 5;
/// The patches with the largest errors are refined until the sum of all errors is this part of the
/// area.
constexpr double kTolerance = kAreaError / 2;
/// Refinement makes so many squares of all patches together, and at least so many of each patch
/// that it takes up.
constexpr int kMostSquares = 1 << 17, kFewSquares = 64;
/// The parts of a core may have this part of its tolerance each.
constexpr double kCoreShare = 4;
/// The number of tiles that one task integrates.
constexpr std::size_t kTilesPerTask = 16;

/// How exactly a tile is to be integrated.
struct Effort {
  double relative, absolute;  ///< error: part of the area, or in units of area; the larger counts
  int most_squares;           ///< refinement makes so many squares
};

/// Integrates tiles. Lengths are in a unit of their own, so that areas neither overflow nor
/// underflow.
class TileArea {
 public:
  explicit TileArea(const SurfacePatches& patches) : patches_(patches) {}

  SurfaceArea operator()(int tile, const Effort& effort) {
    pieces_.clear();
    patches_.appendPieces(tile, pieces_);
    SurfaceArea sum;
    for (const SurfacePiece& piece : pieces_) {
      if (piece.isCore()) {
        return ofCore(piece, effort);
      }
      const BezierPatch patch = patches_.patch(piece);
      add(ofPatches(&patch, 1, effort), sum);
    }
    return sum;
  }

 private:
  static void add(const SurfaceArea& part, SurfaceArea& sum) {
    sum.value += part.value;
    sum.error += part.error;
    sum.evaluations += part.evaluations;
  }

  SurfaceArea ofPatches(const BezierPatch* patches, int count, const Effort& effort) {
    quadrature_.clear();
    quadrature_.keepSquares(effort.most_squares > 0);
    for (int i = 0; i < count; ++i) {
      quadrature_.add(patches[i], effort.relative, effort.absolute);
    }
    quadrature_.refine(effort.absolute, effort.most_squares);
    return quadrature_.result();
  }

  /// A core is a sequence of triples of patches towards the extraordinary vertex. Their areas
  /// become a sum of geometric sequences, so that the areas of the first steps tell the rest.
  SurfaceArea ofCore(SurfacePiece core, Effort effort) {
    SurfacePatches::SplitCore split;
    SurfaceArea sum;
    GeometricSeries series;
    double tolerance = effort.absolute;
    effort.absolute /= kCoreShare;
    while (core.steps < SurfacePatches::kMostSteps) {
      patches_.split(core, split);
      core = split.core;
      const SurfaceArea step = ofPatches(split.patches, 3, effort);
      add(step, sum);
      series.add(step.value);
      if (core.steps == 1) {
        tolerance = std::max(tolerance, effort.relative * step.value);
        effort.absolute = std::max(effort.absolute, effort.relative * step.value / kCoreShare);
        effort.relative = 0;
      }
      // The shares of later steps in the area fall by a factor of 4 or so.
      effort.most_squares /= 2;
      if (series.error() <= tolerance || !(step.value > 0)) {
        break;
      }
    }
    sum.value = series.limit();
    sum.error += series.error();
    return sum;
  }

  const SurfacePatches& patches_;
  std::vector<SurfacePiece> pieces_;
  AreaQuadrature quadrature_;
};

SurfaceArea sumOf(const std::vector<SurfaceArea>& areas) {
  SurfaceArea sum;
  for (const SurfaceArea& area : areas) {
    sum.value += area.value;
    sum.error += area.error;
    sum.evaluations += area.evaluations;
  }
  return sum;
}

/// The tiles with the largest errors, as few as possible, without which the errors' sum is at most
/// `error`.
std::vector<std::size_t> worstTiles(const std::vector<SurfaceArea>& areas, double error) {
  std::vector<std::size_t> order(areas.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return areas[a].error < areas[b].error; });
  std::size_t good = 0;
  for (double sum = 0; good < order.size(); ++good) {
    sum += areas[order[good]].error;
    if (!(sum <= error)) {
      break;
    }
  }
  order.erase(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(good));
  return order;
}

}  // namespace

SurfaceArea measuredArea(const LimitSurface& surface, int threads) {
  checkThreads(threads);
  const SurfacePatches patches(surface, threads, PatchUnit::own);
  std::vector<SurfaceArea> areas(static_cast<std::size_t>(patches.tileCount()));
  parallelFor(areas.size(), kTilesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    TileArea area(patches);
    for (std::size_t tile = begin; tile < end; ++tile) {
      areas[tile] = area(static_cast<int>(tile), {kFirstTolerance, 0, 0});
    }
  });
  SurfaceArea sum = sumOf(areas);
  if (sum.error > kTolerance * sum.value) {
    const std::vector<std::size_t> worst = worstTiles(areas, kTolerance / 2 * sum.value);
    const int count = static_cast<int>(worst.size());
    const Effort effort = {0, kTolerance / 2 * sum.value / count,
                           std::max(kFewSquares, kMostSquares / count)};
    parallelFor(worst.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      TileArea area(patches);
      for (std::size_t i = begin; i < end; ++i) {
        const std::int64_t before = areas[worst[i]].evaluations;
        areas[worst[i]] = area(static_cast<int>(worst[i]), effort);
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
