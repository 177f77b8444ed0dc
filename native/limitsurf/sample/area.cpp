// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/area.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {
namespace {

/// The six points and weights of Gauss-Legendre quadrature on [0, 1].
constexpr int kPoints = 6;
constexpr double kAt[kPoints] = {0.033765242898423975, 0.16939530676686776, 0.38069040695840156,
                                 0.6193095930415985,   0.8306046932331322,  0.966234757101576};
constexpr double kWeight[kPoints] = {0.08566224618958525, 0.1803807865240693, 0.23395696728634546,
                                     0.23395696728634546, 0.1803807865240693, 0.08566224618958525};

/// The quadrature of a square has converged when halving the square changes it by at most this
/// part.
constexpr double kConverged = kAreaError / 10;
constexpr int kMostHalvings = 10;
/// Patches that are at most 2^-kSmallDepth of a face wide are integrated without halving: their
/// share of the area is so small that their relative error may be larger by the same factor.
constexpr int kSmallDepth = 3;
/// The number of tiles that one task integrates.
constexpr std::size_t kTilesPerTask = 8;

/// Adaptive quadrature over squares of a patch's parameters: a square is integrated as a whole and
/// in quarters, and the quarters in the same way until both agree.
class PatchArea {
 public:
  explicit PatchArea(const BezierPatch& patch) : patch_(patch) {}

  double operator()(double s, double t, double size, int halvings) const {
    const double whole = quadrature(s, t, size);
    if (halvings == 0) {
      return whole;
    }
    const double half = size / 2;
    double sum = 0;
    for (int q = 0; q < 4; ++q) {
      sum += quadrature(s + (q & 1) * half, t + (q >> 1) * half, half);
    }
    if (std::abs(sum - whole) <= kConverged * sum) {
      return sum;
    }
    double refined = 0;
    for (int q = 0; q < 4; ++q) {
      refined += (*this)(s + (q & 1) * half, t + (q >> 1) * half, half, halvings - 1);
    }
    return refined;
  }

 private:
  double quadrature(double s0, double t0, double size) const {
    double sum = 0;
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        BezierPatch::Values at;
        patch_.evaluate<1>(s0 + size * kAt[i], t0 + size * kAt[j], at);
        const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>();
        sum += kWeight[i] * kWeight[j] * ds.cross(dt).norm();
      }
    }
    return sum * size * size;
  }

  const BezierPatch& patch_;
};

double areaOf(const BezierPatch& patch, int halvings) {
  return PatchArea(patch)(0, 0, 1, halvings);
}

/// The depth of a piece: it covers a square or a strip of its face that is 2^-depth wide.
int depthOf(const FaceRectangle& on) {
  return -std::ilogb(std::max(std::abs(on.us + on.ut), std::abs(on.vs + on.vt)));
}

/// The area of a core, patch after patch towards the extraordinary vertex, until what remains,
/// which shrinks by a factor below 1/2 with each step, is negligible. The deeper a patch lies, the
/// less its own precision matters.
double areaOfCore(const SurfacePatches& patches, SurfacePiece core) {
  constexpr int kAdaptiveSteps = 6;
  const int tile_depth = depthOf(patches.rectangle(core));
  SurfacePatches::SplitCore split;
  double sum = 0;
  while (core.steps < SurfacePatches::kMostSteps) {
    patches.split(core, split);
    core = split.core;
    const bool adaptive = core.steps + tile_depth <= kAdaptiveSteps;
    const int halvings = adaptive ? kMostHalvings : tile_depth > 0 ? 0 : 1;
    double step = 0;
    for (const BezierPatch& patch : split.patches) {
      step += areaOf(patch, halvings);
    }
    sum += step;
    // A small tile's share of its face's area may be as much less exact.
    if (!(step > std::ldexp(kConverged / 100, 2 * tile_depth) * sum)) {
      break;
    }
  }
  return sum;
}

}  // namespace

double surfaceArea(const LimitSurface& surface, int threads) {
  checkThreads(threads);
  const SurfacePatches patches(surface, threads);
  std::vector<double> areas(static_cast<std::size_t>(patches.tileCount()));
  parallelFor(areas.size(), kTilesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<SurfacePiece> pieces;
    for (std::size_t tile = begin; tile < end; ++tile) {
      pieces.clear();
      patches.appendPieces(static_cast<int>(tile), pieces);
      for (const SurfacePiece& piece : pieces) {
        if (piece.isCore()) {
          areas[tile] += areaOfCore(patches, piece);
        } else {
          const bool small = depthOf(patches.rectangle(piece)) >= kSmallDepth;
          areas[tile] += areaOf(patches.patch(piece), small ? 0 : kMostHalvings);
        }
      }
    }
  });
  return std::accumulate(areas.begin(), areas.end(), 0.);
}

}  // namespace limitsurf
