// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/stencils/stencil_row.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

using Weights = StencilRow::Weights;

void turn(int c, double& du, double& dv) {
  for (; c > 0; --c) {
    const double before = du;
    du = -dv;
    dv = before;
  }
}

void turn(const TileLocation& at, Weights& w) {
  turn(at.turns, w[1], w[2]);
  w[1] = std::ldexp(w[1], at.depth);
  w[2] = std::ldexp(w[2], at.depth);
}

}  // namespace

void StencilRow::set(const TileLocation& at, int order) {
  entries_.clear();
  if (at.tile.kind == TileRef::kBSpline && table_.isOnVertices(table_.bsplines[at.tile.index])) {
    setOnVertices(at);
    return;
  }
  weights_.clear();
  undefined_[0] = undefined_[1] = false;
  if (at.tile.kind == TileRef::kBSpline) {
    forPoints(at, [this](int point, const Weights& w) { weights_.add(point, w); });
  } else {
    addRing(at, order);
  }
  for (auto& entry : weights_.entries()) {
    turn(at, entry.weight);
  }
  if (at.turns % 2 == 1) {
    std::swap(undefined_[0], undefined_[1]);
  }
  weights_.moveToVertices(table_.points);
  for (const auto& entry : weights_.entries()) {
    Weights w = entry.weight;
    for (int d = 0; d < 2; ++d) {
      if (undefined_[d]) {
        w[1 + d] = std::numeric_limits<double>::quiet_NaN();
      }
    }
    entries_.push_back({entry.point, w});
  }
}

/// The same as for refined points, without a map.
void StencilRow::setOnVertices(const TileLocation& at) {
  forPoints(at, [&](int point, const Weights& w) {
    entries_.push_back({point, Weights::Zero() + w});  // 0 for -0
    turn(at, entries_.back().weights);
  });
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.vertex < b.vertex; });
  std::size_t last = 0;
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    if (entries_[i].vertex == entries_[last].vertex) {
      entries_[last].weights += entries_[i].weights;
    } else {
      entries_[++last] = entries_[i];
    }
  }
  entries_.resize(last + 1);
}

template <typename Add>
void StencilRow::forPoints(const TileLocation& at, const Add& add) const {
  const BSplineTile& tile = table_.bsplines[at.tile.index];
  const TileWeights w(tile, at.u, at.v);
  const CubicWeights &u = w.u, &v = w.v;
  double du[4], dv[4];
  u.firstOnPoints(du);
  v.firstOnPoints(dv);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const bool beyond = (x == 0 && tile.x_low) || (x == 3 && tile.x_high) ||
                          (y == 0 && tile.y_low) || (y == 3 && tile.y_high);
      if (!beyond) {
        add(tile.points[4 * y + x],
            {v.value[y] * u.value[x], v.value[y] * du[x], dv[y] * u.value[x]});
      }
    }
  }
}

void StencilRow::addRing(const TileLocation& at, int order) {
  const RingTile& tile = table_.ring_tiles[at.tile.index];
  const RingPoints& ring = table_.rings[tile.ring];
  Eigen::MatrixXd mode_weights, outer_weights;
  if (at.atVertex()) {
    mode_weights = vertexWeights(*ring.basis, tile);
  } else {
    const Quarter quarter(at.u, at.v);
    ring.basis->weights(tile.face, quarter.steps, tile.ring_steps,
                        gridWindow(quarter, tile.sides, order), mode_weights, outer_weights);
  }
  const Eigen::MatrixXd on_ring = ring.basis->projectTransposed(mode_weights.transpose());
  const auto weightsOf = [&](const auto& column) {
    Weights w = Weights::Zero();
    w.head(column.size()) = column.array();
    return w;
  };
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    weights_.add(ring.points[i], weightsOf(on_ring.row(static_cast<Eigen::Index>(i)).transpose()));
  }
  for (Eigen::Index i = 0; i < outer_weights.cols(); ++i) {
    weights_.add(tile.outer[i], weightsOf(outer_weights.col(i)));
  }
}

/// The weights of vertexJet() on modes.
Eigen::MatrixXd StencilRow::vertexWeights(const Eigenbasis& basis, const RingTile& tile) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(3, basis.modeCount());
  w(0, 0) = 1;
  if (basis.ring().closed()) {
    undefined_[0] = undefined_[1] = !vertexIsStationary(basis.ring());
    return w;
  }
  const double first = std::ldexp(1., -tile.ring_steps);
  const double sum = basis.ring().kind == RingKind::pinned ? first : 0;
  undefined_[0] = !onLeft(tile.sides);
  undefined_[1] = !onRight(tile.sides);
  w(1, 1) = first;
  w(1, 2) = sum;
  w(2, 1) = basis.ring().kind == RingKind::loop ? first : -first;
  w(2, 2) = sum;
  return w;
}

}  // namespace limitsurf
