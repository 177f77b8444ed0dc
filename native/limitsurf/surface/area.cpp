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

/// Area of one tile in its own parameters.
class TileArea {
 public:
  TileArea(TileEvaluator& evaluator, TileRef tile) : evaluator_(evaluator) {
    at_.tile = tile;
    at_.turns[0] = at_.turns[1] = 0;
    at_.in_split = false;
  }

  double bspline() { return adaptive(0, 0, 1, kMostHalvings); }

  /// Quarter after quarter towards the extraordinary vertex, until the rest, which shrinks by a
  /// factor below 1/2 a step, is negligible.
  double ring() {
    double sum = 0;
    for (int step = 1; step < 200; ++step) {
      const double size = std::ldexp(1., -step);
      double quarters = 0;
      for (const auto& [a, b] : {std::pair{1, 0}, {1, 1}, {0, 1}}) {
        quarters += adaptive(a * size, b * size, size, step < 3 ? kMostHalvings : 1);
      }
      sum += quarters;
      if (!(quarters > kConverged * 0.01 * sum)) {
        break;
      }
    }
    return sum;
  }

 private:
  double square(double u, double v, double size) {
    double sum = 0;
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        at_.u = u + size * kAt[i];
        at_.v = v + size * kAt[j];
        Jet jet;
        evaluator_.evaluate<1>(at_, jet);
        const Vector3 du = jet.patch.du.head<3>(), dv = jet.patch.dv.head<3>();
        sum += kWeight[i] * kWeight[j] * du.cross(dv).norm();
      }
    }
    return sum * size * size;
  }

  double adaptive(double u, double v, double size, int halvings) {
    const double whole = square(u, v, size);
    if (halvings == 0) {
      return whole;
    }
    const double half = size / 2;
    double quarters[4];
    for (int q = 0; q < 4; ++q) {
      quarters[q] = square(u + (q & 1) * half, v + (q >> 1) * half, half);
    }
    const double sum = std::accumulate(quarters, quarters + 4, 0.);
    if (std::abs(sum - whole) <= kConverged * sum) {
      return sum;
    }
    double refined = 0;
    for (int q = 0; q < 4; ++q) {
      refined += adaptive(u + (q & 1) * half, v + (q >> 1) * half, half, halvings - 1);
    }
    return refined;
  }

  TileEvaluator& evaluator_;
  TileLocation at_;
};

}  // namespace

double LimitSurface::area(int threads) const {
  data_->check({}, threads);
  const TileTable& table = data_->table;
  const std::size_t regular = table.bsplines.size();
  std::vector<double> areas(regular + table.ring_tiles.size());
  parallelFor(areas.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
    TileEvaluator evaluator(table, data_->pose);
    for (std::size_t i = begin; i < end; ++i) {
      if (i < regular) {
        areas[i] =
            TileArea(evaluator, {TileRef::kBSpline, static_cast<std::uint32_t>(i)}).bspline();
      } else {
        areas[i] =
            TileArea(evaluator, {TileRef::kRing, static_cast<std::uint32_t>(i - regular)}).ring();
      }
    }
  });
  return std::accumulate(areas.begin(), areas.end(), 0.);
}

}  // namespace limitsurf
