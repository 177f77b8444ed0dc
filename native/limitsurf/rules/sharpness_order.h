// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "limitsurf/rules/small_array.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// OpenSubdiv's Sdc adds the sharpness of the edges around a vertex in single precision, where the
/// sum of three depends on their order, and with it the surface by up to 1e-9 of the mesh. The
/// edges are handed to Sdc in the order of their sharpness, so that the same mesh with its vertices
/// and faces in another order, or mirrored, has the same surface.
///
/// Returns the edges in that order, and nothing if all sharp edges are equally sharp, so that the
/// sums do not depend on it.
inline SmallArray<int> sharpnessOrder(Span<float> edges) {
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
  SmallArray<int> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  // Equal ones need no order among them: their children are equally sharp, too.
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return edges[a] != edges[b] ? edges[a] < edges[b] : a < b; });
  return order;
}

/// The values in the given order; all of them as they are if there is none.
inline SmallArray<float> inOrder(Span<float> values, const SmallArray<int>& order) {
  SmallArray<float> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[i] = values[order.empty() ? i : static_cast<std::size_t>(order[i])];
  }
  return result;
}

/// Sets the sharpness that each edge around a vertex has after a step.
inline void subdivideSharpness(const OpenSubdiv::Sdc::Crease& crease,
                               const std::vector<float>& edges, std::vector<float>& children) {
  children.resize(edges.size());
  if (crease.IsUniform()) {  // each edge by itself
    std::transform(edges.begin(), edges.end(), children.begin(),
                   [&](float sharpness) { return crease.SubdivideUniformSharpness(sharpness); });
    return;
  }
  const SmallArray<int> order = sharpnessOrder(edges);
  const SmallArray<float> from = inOrder(edges, order);
  SmallArray<float> result(edges.size());
  crease.SubdivideEdgeSharpnessesAroundVertex(static_cast<int>(from.size()), from.data(),
                                              result.data());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    children[order.empty() ? i : static_cast<std::size_t>(order[i])] = result[i];
  }
}

}  // namespace limitsurf
