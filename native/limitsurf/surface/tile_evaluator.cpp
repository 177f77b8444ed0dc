// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tile_evaluator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "limitsurf/patch/single_crease.h"
#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

Quarter::Quarter(double u_, double v_) {
  const double larger = std::max(u_, v_);
  if (larger >= 0x1p-1000) {
    std::uint64_t bits;
    std::memcpy(&bits, &larger, sizeof bits);
    steps =
        std::max(1, 1023 - static_cast<int>(bits >> 52));  // larger in [2^-steps, 2^(1 - steps))
    const double scale = powerOfTwo(steps);
    u = u_ * scale;
    v = v_ * scale;
  } else {
    int exponent;
    std::frexp(larger, &exponent);  // larger in [2^(exponent - 1), 2^exponent)
    steps = 1 - exponent;
    u = std::ldexp(u_, steps);
    v = std::ldexp(v_, steps);
  }
  a = u >= 1 ? 1 : 0;
  b = v >= 1 ? 1 : 0;
  u -= a;
  v -= b;
}

GridWindow gridWindow(const Quarter& quarter, Sides sides, int order) {
  return {quarter.a, quarter.b, CubicWeights(quarter.u, onRight(sides) && quarter.a == 0, false),
          CubicWeights(quarter.v, onLeft(sides) && quarter.b == 0, false), order};
}

namespace {

/// Across a crease along the low side, or along the high one, at t from the low side.
CubicWeights acrossCrease(float sharpness, double t, bool high_side, bool cut) {
  CubicWeights w = SingleCrease(sharpness).weights(high_side ? 1 - t : t, cut);
  if (high_side) {
    std::reverse(w.value, w.value + 4);
    std::reverse(w.first, w.first + 3);
    std::reverse(w.second, w.second + 2);
  }
  return w;
}

}  // namespace

TileWeights::TileWeights(const BSplineTile& tile, double u_, double v_)
    : u(u_, tile.x_low, tile.x_high), v(v_, tile.y_low, tile.y_high) {
  if (tile.crease > 0) {
    switch (tile.crease_side) {
      case 0:
        v = acrossCrease(tile.crease, v_, false, tile.y_high);
        break;
      case 1:
        u = acrossCrease(tile.crease, u_, true, tile.x_low);
        break;
      case 2:
        v = acrossCrease(tile.crease, v_, true, tile.y_low);
        break;
      default:
        u = acrossCrease(tile.crease, u_, false, tile.x_high);
    }
  }
}

TileStrips::TileStrips(const BSplineTile& tile)
    : count(1), side_(tile.crease_side), borders_{0, 1, 1, 1} {
  static_assert(sizeof borders_ == (SingleCrease::kMostStrips + 1) * sizeof(double));
  if (tile.crease > 0) {
    count = SingleCrease(tile.crease).strips(borders_);
  }
}

TileStrips::Strip TileStrips::at(int i) const {
  const double near = borders_[i], far = borders_[i + 1];
  switch (side_) {
    case 0:
      return {0, 1, near, far};
    case 1:
      return {1 - far, 1 - near, 0, 1};
    case 2:
      return {0, 1, 1 - far, 1 - near};
    default:
      return {near, far, 0, 1};
  }
}

TileLocation TileEvaluator::locate(const Location& at) const {
  TileLocation result;
  result.tile = table_.faces[at.face];
  result.u = at.u;
  result.v = at.v;
  result.turns = result.depth = 0;
  while (result.tile.kind == TileRef::kSplit) {
    const bool right = result.u >= 0.5, top = result.v >= 0.5;
    const int child = top ? (right ? 2 : 3) : (right ? 1 : 0);
    result.tile = table_.splits[result.tile.index][child];
    turnParameters(child, result.u, result.v);
    result.u *= 2;
    result.v *= 2;
    result.turns += child;
    ++result.depth;
  }
  if (result.tile.kind == TileRef::kRing) {
    const int corner = table_.ring_tiles[result.tile.index].corner;
    turnParameters(corner, result.u, result.v);
    result.turns += corner;
  }
  result.turns &= 3;
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
    jet.turn(at.turns);
    jet.zoomOut(at.depth);
  }
}

// Always inline: a call would put the weights into memory, which costs a fifth of a position.
template <int Order>
[[gnu::always_inline]] inline void TileEvaluator::evaluateBSpline(const TileLocation& at,
                                                                  const CubicWeights& u,
                                                                  const CubicWeights& v, Jet& jet) {
  const int index = static_cast<int>(at.tile.index);
  const BSplineTile& tile = table_.bsplines[index];
  const Padded& anchor = pose_.point(tile.points[5]);
  jet.anchor = anchor;
  const auto point = [&](int x, int y) -> Padded {
    return pose_.point(tile.points[4 * y + x]) - anchor;
  };
  if (index != loaded_ && (index == last_ || tile.fine)) {  // asked for again: worth keeping
    loaded_ = index;
    for (int i = 0; i < 16; ++i) {
      window_[i] =
          tile.fine ? pose_.difference(tile.points[i], tile.points[5]) : point(i % 4, i / 4);
    }
  }
  last_ = index;
  if (index == loaded_) {
    evaluateWindow<Order>(window_, 4, u, v, jet.patch);
  } else {
    evaluatePatch<Order, Padded>(point, u, v, jet.patch);
  }
}

template <int Order>
void TileEvaluator::evaluateBSpline(const TileLocation& at, Jet& jet) {
  const BSplineTile& tile = table_.bsplines[at.tile.index];
  if (tile.crease > 0) {
    const TileWeights weights(tile, at.u, at.v);
    evaluateBSpline<Order>(at, weights.u, weights.v, jet);
  } else {
    evaluateBSpline<Order>(at, CubicWeights(at.u, tile.x_low, tile.x_high),
                           CubicWeights(at.v, tile.y_low, tile.y_high), jet);
  }
}

template <int Order>
void TileEvaluator::evaluateRing(const TileLocation& at, Jet& jet) {
  const int index = static_cast<int>(at.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Quarter quarter(at.u, at.v);
  const GridWindow window = gridWindow(quarter, tile.sides, Order);
  PatchValues<Padded>& patch = jet.patch;
  if (quarter.steps > pose_.gridSteps(tile)) {
    const Eigenbasis& basis = *table_.rings[tile.ring].basis;
    jet.anchor = pose_.ring(tile.ring).limit;
    // Around a cone the fastest mode vanishes across the spokes, by symmetry, and so must its share
    // of the derivative before it is added to the others'.
    const bool by_modes = Order == 2 || (Order == 1 && basis.ring().kind == RingKind::cone);
    if (!by_modes) {
      Padded grid[tile_grid::kSlots];
      basis.controlGrid(tile.face, quarter.steps, tile.ring_steps,
                        pose_.ring(tile.ring).coefficients, pose_.ringTile(index).outer, grid);
      evaluateWindow<Order>(grid + window.b * tile_grid::kSize + window.a, tile_grid::kSize,
                            window.u, window.v, patch);
      patch.value =
          std::ldexp(1., 1 - quarter.steps) * patch.value + pose_.ring(tile.ring).constant();
      patch.du *= 2;
      patch.dv *= 2;
    } else {
      evaluateByModes(tile, index, quarter.steps, window, patch);
      jet.exponent = quarter.steps - 1;
    }
    return;
  }
  const Pose::Grid& grid = pose_.grid(index, quarter.steps);
  jet.anchor = grid.limit();
  evaluateWindow<Order>(grid.points + window.b * tile_grid::kSize + window.a, tile_grid::kSize,
                        window.u, window.v, patch);
  if (Order > 0) {
    const double scale = powerOfTwo(quarter.steps);
    patch.du *= scale;
    patch.dv *= scale;
    jet.exponent = 2 * quarter.steps;
  }
}

void TileEvaluator::evaluateByModes(const RingTile& tile, int index, int steps,
                                    const GridWindow& window, PatchValues<Padded>& patch) {
  table_.rings[tile.ring].basis->weights(tile.face, steps, tile.ring_steps, window, mode_weights_,
                                         outer_weights_);
  const Points& modes = pose_.ring(tile.ring).coefficients;
  Padded* const values[6] = {&patch.value, &patch.du,  &patch.dv,
                             &patch.duu,   &patch.duv, &patch.dvv};
  for (int d = 0; d < window.count(); ++d) {
    const Vector3 sum = modes.transpose() * mode_weights_.row(d).transpose();
    *values[d] = Padded(sum[0], sum[1], sum[2], 0);
    for (Eigen::Index i = 0; i < outer_weights_.cols(); ++i) {
      *values[d] += outer_weights_(d, i) * pose_.ringTile(index).outer[i];
    }
  }
}

Vector3 TileEvaluator::normalDirection(const TileLocation& at, const Jet& jet) {
  const auto direct = [&]() -> Vector3 {
    return unitNormal(jet.patch.du.head<3>(), jet.patch.dv.head<3>());
  };
  if (at.tile.kind != TileRef::kRing) {
    return direct();
  }
  const int index = static_cast<int>(at.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Quarter quarter(at.u, at.v);
  const Points& modes = pose_.ring(tile.ring).coefficients;
  if (quarter.steps <= kStepsToParallel || modes.rows() > kMostPairedModes) {
    return direct();
  }
  table_.rings[tile.ring].basis->weights(tile.face, quarter.steps, tile.ring_steps,
                                         gridWindow(quarter, tile.sides, 1), mode_weights_,
                                         outer_weights_);
  // du x dv = sum over pairs of (a_i b_j - a_j b_i) p_i x p_j.
  struct Share {
    double a, b;
    Vector3 p;
  };
  std::vector<Share> shares;
  double largest = 0;
  const auto add = [&](double a, double b, const Vector3& p) {
    shares.push_back({a, b, p});
    largest = std::max({largest, std::abs(a), std::abs(b)});
  };
  for (Eigen::Index i = 1; i < modes.rows(); ++i) {
    add(mode_weights_(1, i), mode_weights_(2, i), modes.row(i).transpose());
  }
  for (Eigen::Index i = 0; i < outer_weights_.cols(); ++i) {
    add(outer_weights_(1, i), outer_weights_(2, i),
        pose_.ringTile(index).outer[i].head<3>().matrix());
  }
  if (!(largest > 0)) {
    return direct();
  }
  for (Share& share : shares) {
    share.a /= largest;
    share.b /= largest;
  }
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    for (std::size_t j = i + 1; j < shares.size(); ++j) {
      const Share &s = shares[i], &t = shares[j];
      normal += (s.a * t.b - t.a * s.b) * s.p.cross(t.p);
    }
  }
  return unitDirection(normal);
}

template void TileEvaluator::evaluate<0>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<1>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<2>(const TileLocation&, Jet&);

}  // namespace limitsurf
