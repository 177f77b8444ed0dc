// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

/// Weights on points, in the order of their numbers from the last one to the first, so that refined
/// points come before the points that they are made of. A weight is a number, or an Eigen array of
/// numbers.
template <typename Weight>
using PointWeights = std::map<int, Weight, std::greater<int>>;

inline void addWeight(PointWeights<double>& weights, int point, double weight) {
  weights[point] += weight;
}

inline void addWeight(PointWeights<Eigen::Array3d>& weights, int point,
                      const Eigen::Array3d& weight) {
  weights.try_emplace(point, Eigen::Array3d::Zero()).first->second += weight;
}

/// Replaces refined points by the control mesh's vertices. Cost: O(refined points that the weights
/// depend on).
template <typename Weight>
void moveToVertices(const RefinedPoints& points, PointWeights<Weight>& weights) {
  while (!weights.empty() && weights.begin()->first >= points.cagePoints()) {
    const auto [point, weight] = *weights.begin();
    weights.erase(weights.begin());
    const Span<int> sources = points.sources(point);
    const Span<double> mask = points.weights(point);
    for (std::size_t i = 0; i < sources.size(); ++i) {
      addWeight(weights, sources[i], mask[i] * weight);
    }
  }
}

}  // namespace limitsurf
