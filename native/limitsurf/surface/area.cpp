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

/// Integral of |du x dv| over [0, 1]^2 of a bicubic patch.
class PatchArea {
 public:
  PatchArea(const Padded* window, int stride, bool x_low, bool x_high, bool y_low, bool y_high)
      : window_(window),
        stride_(stride),
        x_low_(x_low),
        x_high_(x_high),
        y_low_(y_low),
        y_high_(y_high) {}

  double operator()(int halvings = kMostHalvings) const { return adaptive(0, 0, 1, halvings); }

 private:
  double square(double u0, double v0, double size) const {
    double sum = 0;
    for (int j = 0; j < kPoints; ++j) {
      const CubicWeights v(v0 + size * kAt[j], y_low_, y_high_);
      for (int i = 0; i < kPoints; ++i) {
        const CubicWeights u(u0 + size * kAt[i], x_low_, x_high_);
        PatchValues<Padded> patch;
        evaluateWindow<1>(window_, stride_, u, v, patch);
        const Vector3 du = patch.du.head<3>(), dv = patch.dv.head<3>();
        sum += kWeight[i] * kWeight[j] * du.cross(dv).norm();
      }
    }
    return sum * size * size;
  }

  double adaptive(double u, double v, double size, int halvings) const {
    const double whole = square(u, v, size);
    if (halvings == 0) {
      return whole;
    }
    const double half = size / 2;
    double sum = 0;
    for (int q = 0; q < 4; ++q) {
      sum += square(u + (q & 1) * half, v + (q >> 1) * half, half);
    }
    if (std::abs(sum - whole) <= kConverged * sum) {
      return sum;
    }
    double refined = 0;
    for (int q = 0; q < 4; ++q) {
      refined += adaptive(u + (q & 1) * half, v + (q >> 1) * half, half, halvings - 1);
    }
    return refined;
  }

  const Padded* window_;
  int stride_;
  bool x_low_, x_high_, y_low_, y_high_;
};

double areaOf(const BSplineTile& tile, const Pose& pose) {
  Padded window[16];
  for (int i = 0; i < 16; ++i) {
    window[i] = pose.point(tile.points[i]) - pose.point(tile.points[5]);
  }
  return PatchArea(window, 4, tile.x_low, tile.x_high, tile.y_low, tile.y_high)();
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
    for (const auto& [a, b] : {std::pair{1, 0}, {1, 1}, {0, 1}}) {
      quarters += PatchArea(grid + b * tile_grid::kSize + a, tile_grid::kSize,
                            onRight(tile.sides) && a == 0, false, onLeft(tile.sides) && b == 0,
                            false)(steps <= kAdaptiveSteps ? kMostHalvings : 1);
    }
    quarters = std::ldexp(quarters, 2 * (1 - steps));  // grids come magnified
    sum += quarters;
    if (!(quarters > kConverged / 100 * sum)) {
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
