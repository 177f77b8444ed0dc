// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/patch/point_weights.h"
#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// The weights of one location on the vertices of the control mesh that it depends on. To be used
/// for one location after another.
class StencilRow {
 public:
  /// The weights of position, du and dv on one vertex.
  using Weights = Eigen::Array3d;
  struct Entry {
    int vertex;
    Weights weights;
  };

  explicit StencilRow(const TileTable& table) : table_(table), weights_(Weights::Zero()) {
    entries_.reserve(16);
  }

  /// Finds the weights of a location, those of du and dv for order 1. At an extraordinary vertex
  /// the weights of derivatives without a limit are NaN.
  void set(const TileLocation& at, int order);

  /// In the order of the vertices.
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void setOnVertices(const TileLocation& at);
  void addRing(const TileLocation& at, int order);
  Eigen::MatrixXd vertexWeights(const Eigenbasis& basis, const RingTile& tile);
  /// Calls add(point, weights) for the points of a regular tile.
  template <typename Add>
  void forPoints(const TileLocation& at, const Add& add) const;

  const TileTable& table_;
  std::vector<Entry> entries_;
  PointWeights<Weights> weights_;
  bool undefined_[2] = {false, false};
};

}  // namespace limitsurf
