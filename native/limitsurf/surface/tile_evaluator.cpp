// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tile_evaluator.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

Quarter::Quarter(double u_, double v_) {
  int exponent;
  std::frexp(std::max(u_, v_), &exponent);  // max(u, v) in [2^(exponent - 1), 2^exponent)
  steps = std::max(1, 1 - exponent);
  u = std::ldexp(u_, steps);
  v = std::ldexp(v_, steps);
  a = u >= 1 ? 1 : 0;
  b = v >= 1 ? 1 : 0;
  u -= a;
  v -= b;
}

WindowWeights windowWeights(const Quarter& quarter, Sides sides, int order) {
  const CubicWeights u(quarter.u, boundaryBefore(quarter, sides), false);
  const CubicWeights v(quarter.v, boundaryBelow(quarter, sides), false);
  const double* u_factors[6] = {u.value, u.first, u.value, u.second, u.first, u.value};
  const double* v_factors[6] = {v.value, v.value, v.first, v.value, v.first, v.second};
  WindowWeights window;
  window.a = quarter.a;
  window.b = quarter.b;
  window.count = order == 0 ? 1 : order == 1 ? 3 : 6;
  for (int d = 0; d < window.count; ++d) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        window.w[d][4 * y + x] = v_factors[d][y] * u_factors[d][x];
      }
    }
  }
  return window;
}

TileLocation TileEvaluator::locate(const Location& at) const {
  TileLocation result;
  result.tile = table_.faces[at.face];
  result.u = at.u;
  result.v = at.v;
  result.turns[0] = result.turns[1] = 0;
  result.in_split = result.tile.kind == TileRef::kSplit;
  if (result.in_split) {
    const bool right = at.u >= 0.5, top = at.v >= 0.5;
    const int child = top ? (right ? 2 : 3) : (right ? 1 : 0);
    result.tile = table_.splits[result.tile.index][child];
    turnParameters(child, result.u, result.v);
    result.u *= 2;
    result.v *= 2;
    result.turns[0] = child;
  }
  if (result.tile.kind == TileRef::kRing) {
    const int corner = table_.ring_tiles[result.tile.index].corner;
    turnParameters(corner, result.u, result.v);
    result.turns[1] = corner;
  }
  return result;
}

template <int Order>
void TileEvaluator::evaluate(const TileLocation& at, Jet& jet) {
  jet.exponent = 0;
  if (at.tile.kind == TileRef::kBSpline) {
    evaluateBSpline<Order>(at, jet);
  } else if (at.atVertex()) {
    vertexJet(table_, pose_, static_cast<int>(at.tile.index), jet);
  } else {
    evaluateRing<Order>(at, jet);
  }
  if (Order > 0) {
    jet.turn(at.turns[1]);
    if (at.in_split) {
      jet.turn(at.turns[0]);
      jet.zoomOut();
    }
  }
}

template <int Order>
void TileEvaluator::evaluateBSpline(const TileLocation& at, Jet& jet) {
  const BSplineTile& tile = table_.bsplines[at.tile.index];
  const Padded& anchor = pose_.point(tile.points[5]);
  if (loaded_ != static_cast<int>(at.tile.index)) {
    loaded_ = static_cast<int>(at.tile.index);
    for (int i = 0; i < 16; ++i) {
      window_[i] = pose_.point(tile.points[i]) - anchor;
    }
  }
  jet.anchor = anchor;
  evaluateWindow<Order>(window_, 4, CubicWeights(at.u, tile.x_low, tile.x_high),
                        CubicWeights(at.v, tile.y_low, tile.y_high), jet);
}

template <int Order>
void TileEvaluator::evaluateRing(const TileLocation& at, Jet& jet) {
  const int index = static_cast<int>(at.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Quarter quarter(at.u, at.v);
  jet.anchor = pose_.ring(tile.ring).limit;
  const Sides sides = table_.rings[tile.ring].basis->sides(tile.face);
  if (quarter.steps > Pose::gridSteps(tile)) {
    const WindowWeights window = windowWeights(quarter, sides, Order);
    table_.rings[tile.ring].basis->weights(tile.face, quarter.steps, tile.ring_steps, window,
                                           mode_weights_, outer_weights_);
    const Points& modes = pose_.ring(tile.ring).coefficients;
    Padded* const values[6] = {&jet.offset, &jet.du, &jet.dv, &jet.duu, &jet.duv, &jet.dvv};
    for (int d = 0; d < window.count; ++d) {
      Vector3 sum = modes.transpose() * mode_weights_.row(d).transpose();
      Padded value(sum[0], sum[1], sum[2], 0);
      for (Eigen::Index i = 0; i < outer_weights_.cols(); ++i) {
        value += outer_weights_(d, i) * pose_.ringTile(index).outer[i];
      }
      *values[d] = value;
    }
    jet.exponent = quarter.steps - 1;
    return;
  }
  const CubicWeights u(quarter.u, boundaryBefore(quarter, sides), false);
  const CubicWeights v(quarter.v, boundaryBelow(quarter, sides), false);
  const Pose::Grid& grid = pose_.grid(index, quarter.steps);
  evaluateWindow<Order>(grid.points + quarter.b * tile_grid::kSize + quarter.a, tile_grid::kSize,
                        u, v, jet);
  if (Order > 0) {
    const double scale = std::ldexp(1., quarter.steps);
    jet.du *= scale;
    jet.dv *= scale;
    jet.exponent = 2 * quarter.steps;
  }
}

template void TileEvaluator::evaluate<0>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<1>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<2>(const TileLocation&, Jet&);

}  // namespace limitsurf
