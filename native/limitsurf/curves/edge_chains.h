// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/curves/mesh_edges.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Chosen edges as chains (EdgeCurves says which): each edge begins where the one before it ends.
struct EdgeChains {
  /// An edge in the direction of its chain, and its use by a face on its left and on its right.
  /// Where no face with a limit surface is on that side, the use's face is -1.
  struct Edge {
    std::array<int, 2> vertices;
    MeshEdges::Use left, right;
  };

  std::vector<std::int64_t> offsets = {0};  ///< of each chain in `edges`, and the end
  std::vector<Edge> edges;
  std::vector<bool> closed;   ///< per chain
  std::int64_t left_out = 0;  ///< the number of chosen edges without a surface

  int count() const { return static_cast<int>(closed.size()); }
};

EdgeChains edgeChains(const LimitSurface& surface, const MeshEdges& edges, EdgeChoice choice);

/// The chains of edges that are given by their vertices, in any order; an edge that is given twice
/// counts once. Throws MeshError for the first one that the mesh does not have.
EdgeChains edgeChains(const LimitSurface& surface, const MeshEdges& edges,
                      const std::vector<std::pair<std::int64_t, std::int64_t>>& chosen);

}  // namespace limitsurf
