// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tile_evaluator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/surface/differential.h"
#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// 16 / kMostNormalCondition. Relative to the size of the whole mesh, this is far above the
/// rounding of derivatives; the factor leaves room for coefficients of modes that are larger than
/// the mesh, and for 8 steps.
constexpr double kFarAboveRounding = 16 / kMostNormalCondition;
/// The points of refined faces are rounded at their own coordinates, so that du and dv err by up to
/// 16 u C there, where C is the mesh's largest coordinate. If the condition number with this part
/// of C in place of the size is at most kMostNormalCondition, that turns a normal by 2^(4 - 53 + 30
/// + 12) = 2^-7 at most.
constexpr double kOfLargestCoordinate = 0x1p-12;

}  // namespace

TileLocation TileEvaluator::locateBelow(TileLocation at) const {
  while (at.tile.kind == TileRef::kSplit) {
    const bool right = at.u >= 0.5, top = at.v >= 0.5;
    const int child = top ? (right ? 2 : 3) : (right ? 1 : 0);
    at.tile = table_.splits[at.tile.index][child];
    turnParameters(child, at.u, at.v);
    at.u *= 2;
    at.v *= 2;
    at.turns += child;
    ++at.depth;
  }
  if (at.tile.kind == TileRef::kRing) {
    const int corner = table_.ring_tiles[at.tile.index].corner;
    turnParameters(corner, at.u, at.v);
    at.turns += corner;
  }
  at.turns &= 3;
  return at;
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

// Always inline: a call would store the weights in memory, which takes a fifth of the time of a
// position.
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
  if (index != loaded_ && (index == last_ || tile.fine)) {  // a second location on the same tile
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
    if (takesModes(basis, Order, at.u, at.v)) {
      evaluateByModes(tile, index, quarter.steps, window, patch);
      jet.exponent = quarter.steps - 1;
      return;
    }
    if (!needsNets(basis, Order)) {
      Padded grid[tile_grid::kSlots];
      basis.controlGrid(tile.face, quarter.steps, tile.ring_steps,
                        pose_.ring(tile.ring).coefficients, pose_.outerPoints(index).points, grid);
      evaluateWindow<Order>(grid + window.b * tile_grid::kSize + window.a, tile_grid::kSize,
                            window.u, window.v, patch);
    } else {
      using derivative_nets::Net, derivative_nets::Selection;
      Padded nets[derivative_nets::kCount];
      basis.derivativeNets(tile.face, quarter.steps, tile.ring_steps,
                           pose_.ring(tile.ring).coefficients, pose_.outerPoints(index).points,
                           Selection::window(quarter.a, quarter.b), nets);
      const int first = window.b * tile_grid::kSize + window.a;
      evaluateNets<Order>(
          [&](Net net, int x, int y) -> const Padded& {
            return nets[derivative_nets::at(net, first + y * tile_grid::kSize + x)];
          },
          window.u, window.v, patch);
      jet.exponent = quarter.steps + 1;
    }
    patch.value =
        std::ldexp(1., 1 - quarter.steps) * patch.value + pose_.ring(tile.ring).constant();
    patch.du *= 2;
    patch.dv *= 2;
    return;
  }
  const Pose::Grid& grid = pose_.grids(index, quarter.steps, own_grids_)[quarter.steps - 1];
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
  const Pose::OuterPoints outer = pose_.outerPoints(index);
  Padded* const values[6] = {&patch.value, &patch.du,  &patch.dv,
                             &patch.duu,   &patch.duv, &patch.dvv};
  for (int d = 0; d < window.count(); ++d) {
    const Vector3 sum = modes.transpose() * mode_weights_.row(d).transpose();
    *values[d] = Padded(sum[0], sum[1], sum[2], 0);
    for (Eigen::Index i = 0; i < outer_weights_.cols(); ++i) {
      *values[d] += outer_weights_(d, i) * outer.points[i];
    }
  }
}

Vector3 TileEvaluator::normalDirection(const TileLocation& at, const Jet& jet) {
  const Vector3 du = jet.patch.du.head<3>(), dv = jet.patch.dv.head<3>();
  if (hasPlainNormal(at, jet)) {
    return unitNormal(du, dv);
  }
  if (!needsModeProducts(at)) {
    return isWellConditioned(du, dv, sizeOf(at)) ? unitNormal(du, dv) : Vector3::Constant(kNaN);
  }
  ModeProducts products;
  gatherModes(at, 1, products);
  const Vector3 cross = products.cross();
  if (!(products.condition(cross) <= kMostNormalCondition)) {
    return Vector3::Constant(kNaN);
  }
  return areApart(du, dv, kLowestSineSquare) ? unitNormal(du, dv) : unitDirection(cross);
}

NormalLimits TileEvaluator::normalLimits(int steps, int depth) const {
  return normalLimits(pose_.size(), steps, depth);
}

NormalLimits TileEvaluator::normalLimits(const PointsSize& points, int steps, int depth) {
  // With n, the rounding of du and dv grows as (2 lambda)^n, which is less than 2^(2n/5 + 1).
  const int growth = steps > kStepsToParallel ? 2 * steps / 5 + 1 : 0;
  const double size = std::max(points.extent, kOfLargestCoordinate * points.largest_coordinate);
  const double least = std::ldexp(kFarAboveRounding * size, depth + growth);
  return {steps > kStepsToParallel ? kLowestSineSquare : 0, least * least};
}

bool TileEvaluator::hasPlainNormal(const TileLocation& at, const Jet& jet) const {
  return meetsLimits(jet.patch.du.head<3>(), jet.patch.dv.head<3>(), normalLimits(at));
}

NormalLimits TileEvaluator::normalLimits(const TileLocation& at) const {
  const bool is_in_quarter = at.tile.kind == TileRef::kRing && !at.atVertex();
  return normalLimits(is_in_quarter ? Quarter(at.u, at.v).steps : 0, at.depth);
}

double TileEvaluator::sizeOf(const TileLocation& at) const {
  double size = 0;
  bool is_refined = at.depth > 0;
  const auto findRefined = [&](const auto& points) {
    is_refined = is_refined || std::any_of(points.begin(), points.end(), [&](int point) {
                   return point >= table_.points.cagePoints();
                 });
  };
  if (at.tile.kind == TileRef::kBSpline) {
    const BSplineTile& tile = table_.bsplines[at.tile.index];
    findRefined(tile.points);
    for (const int point : tile.points) {
      size = std::max(size, pose_.difference(point, tile.points[5]).abs().maxCoeff());
    }
  } else {
    const int index = static_cast<int>(at.tile.index);
    const RingTile& tile = table_.ring_tiles[index];
    const RingPoints& ring = table_.rings[tile.ring];
    const Points& modes = pose_.ring(tile.ring).coefficients;
    size = modes.bottomRows(modes.rows() - 1).cwiseAbs().maxCoeff();
    findRefined(ring.points);
    const Pose::OuterPoints outer = pose_.outerPoints(index);
    for (std::size_t i = 0; i < ring.basis->outerModes(tile.face).slots().size(); ++i) {
      size = std::max(size, outer.points[i].abs().maxCoeff());
    }
  }
  if (is_refined) {
    size = std::max(size, kOfLargestCoordinate * pose_.size().largest_coordinate);
  }
  return std::ldexp(size, at.depth);
}

FundamentalForms TileEvaluator::fundamentalForms(const TileLocation& at, const Jet& jet) {
  if (!needsModeProducts(at)) {
    FundamentalForms forms = limitsurf::fundamentalForms(jet);
    if (!normalDirection(at, jet).allFinite()) {
      forms.cross.setZero();
    }
    return forms;
  }
  ModeProducts products;
  gatherModes(at, 2, products);
  FundamentalForms forms = products.fundamentalForms();
  // Weights of second derivatives lack this factor; see Eigenbasis::weights().
  forms.scale = std::ldexp(forms.scale, Quarter(at.u, at.v).steps - 1);
  return forms;
}

bool TileEvaluator::needsModeProducts(const TileLocation& at) {
  return at.tile.kind == TileRef::kRing && !at.atVertex() &&
         Quarter(at.u, at.v).steps > kStepsToParallel;
}

void TileEvaluator::gatherModes(const TileLocation& at, int order, ModeProducts& products) {
  const int index = static_cast<int>(at.tile.index);
  const RingTile& tile = table_.ring_tiles[index];
  const Quarter quarter(at.u, at.v);
  table_.rings[tile.ring].basis->weights(tile.face, quarter.steps, tile.ring_steps,
                                         gridWindow(quarter, tile.sides, order), mode_weights_,
                                         outer_weights_);
  const Points& modes = pose_.ring(tile.ring).coefficients;
  const Pose::OuterPoints outer = pose_.outerPoints(index);
  products = ModeProducts(order, modes.rows() - 1 + outer_weights_.cols());
  for (Eigen::Index i = 1; i < modes.rows(); ++i) {
    products.add(mode_weights_.col(i), modes.row(i).transpose());
  }
  for (Eigen::Index i = 0; i < outer_weights_.cols(); ++i) {
    products.add(outer_weights_.col(i), outer.points[i].head<3>().matrix());
  }
  products.sort();
}

template void TileEvaluator::evaluate<0>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<1>(const TileLocation&, Jet&);
template void TileEvaluator::evaluate<2>(const TileLocation&, Jet&);

}  // namespace limitsurf
