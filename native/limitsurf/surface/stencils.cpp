// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "limitsurf/patch/point_weights.h"
#include "limitsurf/surface/limit_surface_data.h"
#include "limitsurf/surface/tile_weights.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {
namespace {

/// A row takes much longer than an evaluation, so that a task has fewer of them than kRowsPerTask.
constexpr std::size_t kStencilsPerTask = 8;
/// So many are made before they are put together.
constexpr std::size_t kStencilsPerChunk = std::size_t{1} << 17;
/// So many blocks of them are copied by one task.
constexpr std::size_t kBlocksPerCopy = 64;

/// The weights of position, du and dv on one point.
using Weights = Eigen::Array3d;

/// The weights of one location on the vertices that it depends on.
class Row {
 public:
  struct Entry {
    int vertex;
    Weights weights;
  };

  explicit Row(const TileTable& table) : table_(table), weights_(Weights::Zero()) {
    entries_.reserve(16);
  }

  void set(const TileLocation& at, int order) {
    entries_.clear();
    if (at.tile.kind == TileRef::kBSpline && isOnVertices(table_.bsplines[at.tile.index])) {
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

  /// In the order of the vertices.
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  bool isOnVertices(const BSplineTile& tile) const {
    return std::all_of(tile.points.begin(), tile.points.end(),
                       [&](int point) { return point < table_.points.cagePoints(); });
  }

  /// The same as for refined points, without a map.
  void setOnVertices(const TileLocation& at) {
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

  static void turn(const TileLocation& at, Weights& w) {
    turn(at.turns, w[1], w[2]);
    w[1] = std::ldexp(w[1], at.depth);
    w[2] = std::ldexp(w[2], at.depth);
  }
  static void turn(int c, double& du, double& dv) {
    for (; c > 0; --c) {
      const double before = du;
      du = -dv;
      dv = before;
    }
  }

  /// Calls add(point, weights) for the points of a regular tile.
  template <typename Add>
  void forPoints(const TileLocation& at, const Add& add) const {
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
      weights_.add(ring.points[i],
                   weightsOf(on_ring.row(static_cast<Eigen::Index>(i)).transpose()));
    }
    for (Eigen::Index i = 0; i < outer_weights.cols(); ++i) {
      weights_.add(tile.outer[i], weightsOf(outer_weights.col(i)));
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
  std::vector<Entry> entries_;
  PointWeights<Weights> weights_;
  bool undefined_[2] = {false, false};
};

/// The stencils that one task has made.
struct Block {
  /// Makes room for rows like most rows: memory for each entry by itself takes as long as its
  /// weights.
  void reserve(std::size_t rows, bool first_derivatives) {
    sizes.reserve(rows);
    indices.reserve(16 * rows);
    for (int kind = 0; kind < (first_derivatives ? 3 : 1); ++kind) {
      weights[kind].reserve(16 * rows);
    }
  }

  void add(const std::vector<Row::Entry>& entries, bool first_derivatives) {
    sizes.push_back(static_cast<std::int64_t>(entries.size()));
    for (const Row::Entry& entry : entries) {
      indices.push_back(entry.vertex);
      for (int kind = 0; kind < (first_derivatives ? 3 : 1); ++kind) {
        weights[kind].push_back(entry.weights[kind]);
      }
    }
  }

  std::vector<std::int64_t> sizes;  // of its rows
  std::vector<int> indices;
  std::vector<double> weights[3];  // of position, du and dv
};

/// Gives a vector this size. Where it must grow, it gets room for all rows if they are like the
/// first `rows` of `all`.
template <typename Vector>
void resizeFor(Vector& values, std::size_t size, std::size_t rows, std::size_t all) {
  if (size > values.capacity()) {
    const double share = static_cast<double>(all) / static_cast<double>(rows);
    values.reserve(static_cast<std::size_t>(1.02 * share * static_cast<double>(size)) + 1);
  }
  values.resize(size);
}

/// Appends the stencils of rows from `begin` on, and frees the blocks.
void append(std::vector<Block>& blocks, std::size_t begin, bool first_derivatives, int threads,
            Stencils& out) {
  std::vector<std::size_t> first(blocks.size() + 1, out.indices.size());  // entry of each block
  std::size_t rows = begin;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    first[i + 1] = first[i] + blocks[i].indices.size();
    rows += blocks[i].sizes.size();
  }
  const int kinds = first_derivatives ? 3 : 1;
  const std::size_t all = out.offsets.size() - 1;
  resizeFor(out.indices, first.back(), rows, all);
  LargePageVector<double>* const weights[3] = {&out.weights, &out.du_weights, &out.dv_weights};
  for (int kind = 0; kind < kinds; ++kind) {
    resizeFor(*weights[kind], first.back(), rows, all);
  }
  parallelFor(blocks.size(), kBlocksPerCopy, threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Block block = std::move(blocks[i]);
      auto offset = static_cast<std::int64_t>(first[i]);
      for (std::size_t row = 0; row < block.sizes.size(); ++row) {
        offset += block.sizes[row];
        out.offsets[begin + i * kStencilsPerTask + row + 1] = offset;
      }
      std::copy(block.indices.begin(), block.indices.end(), out.indices.data() + first[i]);
      for (int kind = 0; kind < kinds; ++kind) {
        std::copy(block.weights[kind].begin(), block.weights[kind].end(),
                  weights[kind]->data() + first[i]);
      }
    }
  });
}

}  // namespace

Stencils LimitSurface::stencils(const LocationBatch& at, bool first_derivatives,
                                int threads) const {
  const LocationBatch checked = checkLocations(at, threads);
  Stencils out;
  out.offsets.resize(at.size() + 1);
  out.offsets[0] = 0;
  for (std::size_t begin = 0; begin < at.size(); begin += kStencilsPerChunk) {
    const std::size_t count = std::min(kStencilsPerChunk, at.size() - begin);
    std::vector<Block> blocks((count + kStencilsPerTask - 1) / kStencilsPerTask);
    parallelFor(count, kStencilsPerTask, threads, [&](std::size_t first, std::size_t last) {
      const TileEvaluator evaluator(data_->table, data_->pose);
      Row row(data_->table);
      Block& block = blocks[first / kStencilsPerTask];
      block.reserve(last - first, first_derivatives);
      for (std::size_t i = first; i < last; ++i) {
        row.set(evaluator.locate(checked[begin + i]), first_derivatives ? 1 : 0);
        block.add(row.entries(), first_derivatives);
      }
    });
    append(blocks, begin, first_derivatives, threads, out);
  }
  return out;
}

}  // namespace limitsurf
