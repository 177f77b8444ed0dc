// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limitsurf/surface/limit_surface_data.h"

namespace limitsurf {
namespace {

/// One coordinate of a bicubic patch in Bezier form, whose coefficients bound it.
using Bezier = std::array<double, 16>;

/// Uniform B-spline control points p0..p3, `stride` apart, to Bezier points of the middle span.
void toBezier(double* p, int stride) {
  const double p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
  p[0] = (p0 + 4 * p1 + p2) / 6;
  p[stride] = (2 * p1 + p2) / 3;
  p[2 * stride] = (p1 + 2 * p2) / 3;
  p[3 * stride] = (p1 + 4 * p2 + p3) / 6;
}

/// De Casteljau at 1/2: the lower half replaces `low`, the upper one goes to `high`.
void halve(double* low, double* high, int stride) {
  const double a = low[0], b = low[stride], c = low[2 * stride], d = low[3 * stride];
  const double ab = (a + b) / 2, bc = (b + c) / 2, cd = (c + d) / 2;
  const double abc = (ab + bc) / 2, bcd = (bc + cd) / 2, middle = (abc + bcd) / 2;
  low[stride] = ab;
  low[2 * stride] = abc;
  low[3 * stride] = middle;
  high[0] = middle;
  high[stride] = bcd;
  high[2 * stride] = cd;
  high[3 * stride] = d;
}

/// The maximum of each coordinate and of its negative, by branch and bound.
struct Extremes {
  std::array<double, 6> most;

  Extremes() { most.fill(-std::numeric_limits<double>::infinity()); }

  void include(const Padded& point) {
    for (int i = 0; i < 3; ++i) {
      most[i] = std::max(most[i], point[i]);
      most[3 + i] = std::max(most[3 + i], -point[i]);
    }
  }
};

constexpr int kMostHalvings = 60;

/// Raises `most` to the patch's maximum where that exceeds it by more than `tolerance`.
void raise(const Bezier& patch, double tolerance, int halvings, double& most) {
  most = std::max({most, patch[0], patch[3], patch[12], patch[15]});
  if (*std::max_element(patch.begin(), patch.end()) <= most + tolerance || halvings == 0) {
    return;
  }
  Bezier quarter[4];
  quarter[0] = patch;
  for (int row = 0; row < 4; ++row) {
    halve(&quarter[0][4 * row], &quarter[1][4 * row], 1);
  }
  for (int half = 0; half < 2; ++half) {
    for (int column = 0; column < 4; ++column) {
      halve(&quarter[half][column], &quarter[2 + half][column], 4);
    }
  }
  for (const Bezier& q : quarter) {
    raise(q, tolerance, halvings - 1, most);
  }
}

/// `values`: 4 x 4 numbers that determine the patch; `convert` turns four of them along an axis
/// into Bezier coefficients.
template <typename Convert>
void includeBezier(const Padded values[16], const Padded& anchor, double tolerance,
                   Extremes& extremes, const Convert& convert) {
  for (int axis = 0; axis < 3; ++axis) {
    Bezier patch;
    for (int i = 0; i < 16; ++i) {
      patch[i] = values[i][axis];
    }
    for (int i = 0; i < 4; ++i) {
      convert(&patch[4 * i], 1);
    }
    for (int i = 0; i < 4; ++i) {
      convert(&patch[i], 4);
    }
    for (const int sign : {1, -1}) {
      Bezier signed_patch = patch;
      for (double& c : signed_patch) {
        c = sign * (anchor[axis] + c);
      }
      raise(signed_patch, tolerance, kMostHalvings, extremes.most[sign > 0 ? axis : 3 + axis]);
    }
  }
}

/// Fills a side's missing points by linear continuation.
void continueLow(Padded* p, int along, int across) {
  for (int i = 0; i < 4; ++i) {
    p[i * along] = 2 * p[i * along + across] - p[i * along + 2 * across];
  }
}

/// Bezier coefficients of a cubic from its values at 0, 1/3, 2/3 and 1, `stride` apart.
void interpolateBezier(double* p, int stride) {
  const double p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
  p[stride] = (-5 * p0 + 18 * p1 - 9 * p2 + 2 * p3) / 6;
  p[2 * stride] = (2 * p0 - 9 * p1 + 18 * p2 - 5 * p3) / 6;
}

/// A tile with a crease, strip by strip.
void includeStrips(const BSplineTile& tile, const Padded window[16], const Padded& anchor,
                   double tolerance, Extremes& extremes) {
  const TileStrips strips(tile);
  for (int i = 0; i < strips.count; ++i) {
    const TileStrips::Strip s = strips.at(i);
    Padded values[16];
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const TileWeights w(tile, s.u0 + (s.u1 - s.u0) * x / 3, s.v0 + (s.v1 - s.v0) * y / 3);
        PatchValues<Padded> patch;
        evaluateWindow<0>(window, 4, w.u, w.v, patch);
        values[4 * y + x] = patch.value;
      }
    }
    includeBezier(values, anchor, tolerance, extremes, interpolateBezier);
  }
}

void includeBSpline(const BSplineTile& tile, const Pose& pose, double tolerance,
                    Extremes& extremes) {
  const Padded anchor = pose.point(tile.points[5]);
  Padded window[16];
  for (int i = 0; i < 16; ++i) {
    window[i] = pose.difference(tile.points[i], tile.points[5]);
  }
  if (tile.crease > 0) {
    includeStrips(tile, window, anchor, tolerance, extremes);
    return;
  }
  if (tile.x_low) {
    continueLow(window, 4, 1);
  }
  if (tile.x_high) {
    continueLow(window + 3, 4, -1);
  }
  if (tile.y_low) {
    continueLow(window, 1, 4);
  }
  if (tile.y_high) {
    continueLow(window + 12, 1, -4);
  }
  includeBezier(window, anchor, tolerance, extremes, toBezier);
}

/// A ring tile, quarter after quarter towards its vertex, until what is left can no longer matter.
class RingTileBounds {
 public:
  RingTileBounds(const TileTable& table, const Pose& pose, int tile)
      : tile_(table.ring_tiles[tile]),
        basis_(*table.rings[tile_.ring].basis),
        ring_(pose.ring(tile_.ring)),
        pose_(pose.ringTile(tile)) {
    boundShares();
  }

  void include(double tolerance, Extremes& extremes) {
    extremes.include(ring_.limit);
    if (restIsWithin(0, tolerance, extremes)) {
      return;
    }
    for (int steps = 1; steps < kMostSteps; ++steps) {
      basis_.controlGrid(tile_.face, steps, tile_.ring_steps, ring_.coefficients, pose_.outer,
                         grid_);
      for (Padded& point : grid_) {
        point = std::ldexp(1., 1 - steps) * point + ring_.constant();
      }
      for (const auto& [a, b] : {std::pair{1, 0}, {1, 1}, {0, 1}}) {
        includeQuarter(a, b, tolerance, extremes);
      }
      if (restIsWithin(steps, tolerance, extremes)) {
        return;
      }
    }
  }

 private:
  static constexpr int kMostSteps = 400;

  void includeQuarter(int a, int b, double tolerance, Extremes& extremes) {
    Padded window[16];
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        window[4 * y + x] = grid_[(b + y) * tile_grid::kSize + a + x];
      }
    }
    if (onRight(tile_.sides) && a == 0) {
      continueLow(window, 4, 1);
    }
    if (onLeft(tile_.sides) && b == 0) {
      continueLow(window, 1, 4);
    }
    includeBezier(window, ring_.limit, tolerance, extremes, toBezier);
  }

  /// What a mode can contribute, at most, to a coordinate of a control point after n steps:
  /// size (1 + n chained) lambda^n.
  struct Share {
    double lambda;
    Vector3 size;
    double chained;
  };

  void boundShares() {
    const OuterModes<double>& outer = basis_.outerModes(tile_.face);
    Vector3 outer_size = Vector3::Zero();
    for (int i = 0; i < outer.count(); ++i) {
      outer_size += pose_.outer[i].abs().head<3>().matrix();
    }
    for (int mode = 0; mode < basis_.modeCount(); ++mode) {
      const Eigenbasis::Table table = basis_.table(mode, tile_.face);
      const Vector3 coefficient = ring_.coefficients.row(mode).cwiseAbs().transpose();
      double largest = 0;
      for (const double value : table.grid) {
        largest = std::max(largest, std::abs(value));
      }
      for (const double value : table.outer) {
        outer_size += coefficient * std::abs(value);
      }
      const double lambda = std::abs(basis_.eigenvalue(mode));
      if (mode > 0 && lambda > 0) {  // the constant is 0: points are relative to the limit
        shares_.push_back({lambda, coefficient * largest / lambda, 0});
        for (const Eigenbasis::Chain& chain : basis_.chains()) {
          if (chain.from == mode) {
            shares_.push_back(
                {lambda, coefficient * kLargestEntry / lambda, std::abs(chain.rate) / lambda});
          }
        }
      }
    }
    const double condition = outer.vectors().cwiseAbs().rowwise().sum().maxCoeff() *
                             outer.inverse().cwiseAbs().rowwise().sum().maxCoeff();
    shares_.push_back({1. / 8, 8 * kLargestEntry * condition * outer_size, 1});
  }

  /// Whether all quarters deeper than `steps` stay within what is known.
  bool restIsWithin(int steps, double tolerance, const Extremes& extremes) const {
    Vector3 reach = Vector3::Zero();
    for (const Share& share : shares_) {
      reach += share.size * (1 + steps * share.chained) * std::pow(share.lambda, steps);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (ring_.limit[axis] + reach[axis] > extremes.most[axis] + tolerance ||
          -ring_.limit[axis] + reach[axis] > extremes.most[3 + axis] + tolerance) {
        return false;
      }
    }
    return true;
  }

  /// No entry of a unit spoke mode's or outer mode's table is larger.
  static constexpr double kLargestEntry = 64;

  const RingTile& tile_;
  const Eigenbasis& basis_;
  const Pose::RingPose& ring_;
  const Pose::RingTilePose& pose_;
  std::vector<Share> shares_;
  Padded grid_[tile_grid::kCells];
};

}  // namespace

Eigen::Matrix<double, 2, 3, Eigen::RowMajor> LimitSurface::bounds(int threads) const {
  data_->check({}, threads);
  const TileTable& table = data_->table;
  const Eigen::RowVector3d cage = data_->positions.rows() > 0
                                      ? Eigen::RowVector3d(data_->positions.colwise().maxCoeff() -
                                                           data_->positions.colwise().minCoeff())
                                      : Eigen::RowVector3d::Zero();
  const double tolerance = kPositionError / 4 * cage.norm();

  // A first guess prunes most tiles; each block then goes on from it alone, so that the result does
  // not depend on which block was first.
  Extremes guess;
  for (const Location& at : vertexLocations()) {
    if (at.face >= 0) {
      TileEvaluator evaluator(table, data_->pose);
      Jet jet;
      evaluator.evaluate<0>(evaluator.locate(at), jet);
      guess.include(jet.anchor + jet.patch.value);
    }
  }
  constexpr std::size_t kBlock = 1024;
  const std::size_t regular = table.bsplines.size(), tiles = regular + table.ring_tiles.size();
  std::vector<Extremes> blocks((tiles + kBlock - 1) / kBlock, guess);
  parallelFor(blocks.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      for (std::size_t i = block * kBlock; i < std::min(tiles, (block + 1) * kBlock); ++i) {
        if (i < regular) {
          includeBSpline(table.bsplines[i], data_->pose, tolerance, blocks[block]);
        } else {
          RingTileBounds(table, data_->pose, static_cast<int>(i - regular))
              .include(tolerance, blocks[block]);
        }
      }
    }
  });
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> box;
  if (tiles == 0) {
    box.setConstant(std::numeric_limits<double>::quiet_NaN());
    return box;
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const Extremes& block : blocks) {
      guess.most[axis] = std::max(guess.most[axis], block.most[axis]);
      guess.most[3 + axis] = std::max(guess.most[3 + axis], block.most[3 + axis]);
    }
    box(0, axis) = -guess.most[3 + axis];
    box(1, axis) = guess.most[axis];
  }
  return box;
}

}  // namespace limitsurf
