// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace limitsurf {

/// OpenSubdiv's Sdc adds the sharpness of the edges around a vertex in single precision, where the
/// sum of three depends on their order, and with it the surface by up to 1e-9 of the mesh. The
/// edges are handed to Sdc in the order of their sharpness, so that the same mesh with its vertices
/// and faces in another order, or mirrored, has the same surface.
///
/// Returns the edges in that order, and nothing if all sharp edges are equally sharp, so that the
/// sums do not depend on it.
inline std::vector<int> sharpnessOrder(const std::vector<float>& edges) {
  float first = 0;
  const bool matters = std::any_of(edges.begin(), edges.end(), [&](float sharpness) {
    if (!OpenSubdiv::Sdc::Crease::IsSharp(sharpness)) {
      return false;
    }
    if (first == 0) {
      first = sharpness;
    }
    return sharpness != first;
  });
  if (!matters) {
    return {};
  }
  std::vector<int> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  // Equal ones need no order among them: their children are equally sharp, too.
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return edges[a] < edges[b]; });
  return order;
}

/// The values in the given order; all of them as they are if there is none.
inline std::vector<float> inOrder(const std::vector<float>& values, const std::vector<int>& order) {
  if (order.empty()) {
    return values;
  }
  std::vector<float> result;
  result.reserve(order.size());
  for (const int i : order) {
    result.push_back(values[i]);
  }
  return result;
}

/// The sharpness that each edge around a vertex has after a step.
inline std::vector<float> subdividedSharpness(const OpenSubdiv::Sdc::Crease& crease,
                                              const std::vector<float>& edges) {
  const std::vector<int> order = sharpnessOrder(edges);
  const std::vector<float> from = inOrder(edges, order);
  std::vector<float> children(from.size());
  crease.SubdivideEdgeSharpnessesAroundVertex(static_cast<int>(from.size()), from.data(),
                                              children.data());
  if (order.empty()) {
    return children;
  }
  std::vector<float> result(children.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    result[order[i]] = children[i];
  }
  return result;
}

}  // namespace limitsurf
