// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// Gauss-Legendre points and weights on [0, 1], six of them.
constexpr int kPoints = 6;
constexpr double kAt[kPoints] = {0.033765242898423975, 0.16939530676686776, 0.38069040695840156,
                                 0.6193095930415985,   0.8306046932331322,  0.966234757101576};
constexpr double kWeight[kPoints] = {0.08566224618958525, 0.1803807865240693, 0.23395696728634546,
                                     0.23395696728634546, 0.1803807865240693, 0.08566224618958525};

/// Halving a square changes its integral by less than this once the quadrature has converged.
constexpr double kConverged = kAreaError / 10;
constexpr int kMostHalvings = 10;

/// Integral of |du x dv| over a part of a bicubic patch. `weights(u, v)`: those of its window's
/// points along each axis.
template <typename Weights>
class PatchArea {
 public:
  PatchArea(const Padded* window, int stride, const Weights& weights)
      : window_(window), stride_(stride), weights_(weights) {}

  double operator()(double u, double v, double width, double height, int halvings) const {
    const double whole = quadrature(u, v, width, height);
    if (halvings == 0) {
      return whole;
    }
    const double w = width / 2, h = height / 2;
    double sum = 0;
    for (int q = 0; q < 4; ++q) {
      sum += quadrature(u + (q & 1) * w, v + (q >> 1) * h, w, h);
    }
    if (std::abs(sum - whole) <= kConverged * sum) {
      return sum;
    }
    double refined = 0;
    for (int q = 0; q < 4; ++q) {
      refined += (*this)(u + (q & 1) * w, v + (q >> 1) * h, w, h, halvings - 1);
    }
    return refined;
  }

 private:
  double quadrature(double u0, double v0, double width, double height) const {
    double sum = 0;
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        const auto w = weights_(u0 + width * kAt[i], v0 + height * kAt[j]);
        PatchValues<Padded> patch;
        evaluateWindow<1>(window_, stride_, w.u, w.v, patch);
        const Vector3 du = patch.du.head<3>(), dv = patch.dv.head<3>();
        sum += kWeight[i] * kWeight[j] * du.cross(dv).norm();
      }
    }
    return sum * width * height;
  }

  const Padded* window_;
  int stride_;
  const Weights& weights_;
};

double areaOf(const BSplineTile& tile, const Pose& pose) {
  Padded window[16];
  for (int i = 0; i < 16; ++i) {
    window[i] = pose.difference(tile.points[i], tile.points[5]);
  }
  const auto weights = [&](double u, double v) { return TileWeights(tile, u, v); };
  const PatchArea area(window, 4, weights);
  double sum = 0;
  const TileStrips strips(tile);
  for (int i = 0; i < strips.count; ++i) {
    const TileStrips::Strip s = strips.at(i);
    sum += area(s.u0, s.v0, s.u1 - s.u0, s.v1 - s.v0, tile.fine ? 0 : kMostHalvings);
  }
  return sum;
}

/// Quarter after quarter towards the extraordinary vertex, until the rest, which shrinks by a
/// factor below 1/2 a step, is negligible. The deeper a quarter, the less its own precision
/// matters.
double areaOf(const TileTable& table, const Pose& pose, int index) {
  const RingTile& tile = table.ring_tiles[index];
  const Eigenbasis& basis = *table.rings[tile.ring].basis;
  constexpr int kMostSteps = 200, kAdaptiveSteps = 6;
  double sum = 0;
  for (int steps = 1; steps <= kMostSteps; ++steps) {
    Padded grid[tile_grid::kCells];
    basis.controlGrid(tile.face, steps, tile.ring_steps, pose.ring(tile.ring).coefficients,
                      pose.ringTile(index).outer, grid);
    double quarters = 0;
    const int depth = steps + tile.depth;
    const int halvings = depth <= kAdaptiveSteps ? kMostHalvings : tile.depth > 0 ? 0 : 1;
    for (const auto& quarter : {std::pair{1, 0}, {1, 1}, {0, 1}}) {
      const int a = quarter.first, b = quarter.second;
      struct Weights {
        CubicWeights u, v;
      };
      const bool x_low = onRight(tile.sides) && a == 0, y_low = onLeft(tile.sides) && b == 0;
      const auto weights = [&](double u, double v) {
        return Weights{CubicWeights(u, x_low, false), CubicWeights(v, y_low, false)};
      };
      quarters += PatchArea(grid + b * tile_grid::kSize + a, tile_grid::kSize, weights)(0, 0, 1, 1,
                                                                                        halvings);
    }
    quarters = std::ldexp(quarters, 2 * (1 - steps));  // grids come magnified
    sum += quarters;
    // A small tile's share of its face's area may be as much less exact.
    if (!(quarters > std::ldexp(kConverged / 100, 2 * tile.depth) * sum)) {
      break;
    }
  }
  return sum;
}

}  // namespace

double LimitSurface::area(int threads) const {
  data_->check({}, threads);
  const TileTable& table = data_->table;
  const std::size_t regular = table.bsplines.size();
  std::vector<double> areas(regular + table.ring_tiles.size());
  parallelFor(areas.size(), 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      areas[i] = i < regular ? areaOf(table.bsplines[i], data_->pose)
                             : areaOf(table, data_->pose, static_cast<int>(i - regular));
    }
  });
  return std::accumulate(areas.begin(), areas.end(), 0.);
}

}  // namespace limitsurf
