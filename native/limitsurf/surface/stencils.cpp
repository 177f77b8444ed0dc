// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <vector>

#include "limitsurf/patch/point_weights.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

/// A row takes much longer than an evaluation, so that a task has fewer of them than kRowsPerTask.
constexpr std::size_t kStencilsPerTask = 8;

/// The weights of position, du and dv on one point.
using Weights = Eigen::Array3d;

/// The weights of one location on all points that it depends on, refined points first.
class Row {
 public:
  explicit Row(const TileTable& table) : table_(table) {}

  void set(const TileLocation& at, int order) {
    weights_.clear();
    undefined_[0] = undefined_[1] = false;
    if (at.tile.kind == TileRef::kBSpline) {
      addBSpline(at);
    } else {
      addRing(at, order);
    }
    for (auto& [point, w] : weights_) {
      turn(at.turns, w[1], w[2]);
      w[1] = std::ldexp(w[1], at.depth);
      w[2] = std::ldexp(w[2], at.depth);
    }
    if (at.turns % 2 == 1) {
      std::swap(undefined_[0], undefined_[1]);
    }
    moveToVertices(table_.points, weights_);
    for (auto& [point, w] : weights_) {
      for (int d = 0; d < 2; ++d) {
        if (undefined_[d]) {
          w[1 + d] = std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
  }

  const PointWeights<Weights>& weights() const { return weights_; }

 private:
  static void turn(int c, double& du, double& dv) {
    for (; c > 0; --c) {
      const double before = du;
      du = -dv;
      dv = before;
    }
  }

  void add(int point, const Weights& w) { addWeight(weights_, point, w); }

  void addBSpline(const TileLocation& at) {
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

  void addRing(const TileLocation& at, int order) {
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
      add(ring.points[i], weightsOf(on_ring.row(static_cast<Eigen::Index>(i)).transpose()));
    }
    for (Eigen::Index i = 0; i < outer_weights.cols(); ++i) {
      add(tile.outer[i], weightsOf(outer_weights.col(i)));
    }
  }

  /// The weights of vertexJet() on modes.
  Eigen::MatrixXd vertexWeights(const Eigenbasis& basis, const RingTile& tile) {
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

  const TileTable& table_;
  PointWeights<Weights> weights_;
  bool undefined_[2] = {false, false};
};

}  // namespace

Stencils LimitSurface::stencils(const LocationBatch& at, bool first_derivatives,
                                int threads) const {
  data_->check(at, threads);
  struct Entry {
    int index;
    Weights weights;
  };
  std::vector<std::vector<Entry>> rows(at.size());
  parallelFor(at.size(), kStencilsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    const TileEvaluator evaluator(data_->table, data_->pose);
    Row row(data_->table);
    for (std::size_t i = begin; i < end; ++i) {
      row.set(evaluator.locate(at[i]), first_derivatives ? 1 : 0);
      rows[i].reserve(row.weights().size());
      for (auto entry = row.weights().rbegin(); entry != row.weights().rend(); ++entry) {
        rows[i].push_back({entry->first, entry->second});
      }
    }
  });

  Stencils out;
  out.offsets.reserve(at.size() + 1);
  out.offsets.push_back(0);
  InterruptionStride stride;
  for (const std::vector<Entry>& row : rows) {
    stride.step();
    out.offsets.push_back(out.offsets.back() + static_cast<std::int64_t>(row.size()));
    for (const Entry& entry : row) {
      out.indices.push_back(entry.index);
      out.weights.push_back(entry.weights[0]);
      if (first_derivatives) {
        out.du_weights.push_back(entry.weights[1]);
        out.dv_weights.push_back(entry.weights[2]);
      }
    }
  }
  return out;
}

}  // namespace limitsurf
