// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/cut_edges.h"

#include <algorithm>
#include <string>

#include "limitsurf/interruptible_sort.h"

namespace limitsurf {

std::vector<std::uint8_t> cutCorners(const ControlMesh& mesh, const EdgeList& edges) {
  std::vector<std::uint8_t> is_cut(mesh.faceVertices().size());
  if (edges.empty()) {
    return is_cut;
  }
  const auto sorted = [](std::int64_t a, std::int64_t b) { return std::minmax({a, b}); };
  EdgeList wanted;
  wanted.reserve(edges.size());
  InterruptionStride stride;
  for (const auto& [a, b] : edges) {
    stride.step();
    wanted.push_back(sorted(a, b));
  }
  EdgeList known = wanted;
  sortInterruptibly(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  std::vector<std::uint8_t> found(known.size());
  for (int face = 0; face < mesh.faceCount(); ++face) {
    stride.step();
    const Span<int> vertices = mesh.faceVertices(face);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const std::pair<std::int64_t, std::int64_t> edge =
          sorted(vertices[k], vertices[(k + 1) % vertices.size()]);
      const auto at = std::lower_bound(known.begin(), known.end(), edge);
      if (at != known.end() && *at == edge) {
        is_cut[static_cast<std::size_t>(mesh.firstCorner(face)) + k] = 1;
        found[static_cast<std::size_t>(at - known.begin())] = 1;
      }
    }
  }
  for (std::size_t row = 0; row < wanted.size(); ++row) {
    stride.step();
    const auto at = std::lower_bound(known.begin(), known.end(), wanted[row]);
    if (!found[static_cast<std::size_t>(at - known.begin())]) {
      throw MeshError("cuts: row " + std::to_string(row) + ": vertices " +
                      std::to_string(edges[row].first) + " and " +
                      std::to_string(edges[row].second) + " have no edge of a face between them");
    }
  }
  return is_cut;
}

}  // namespace limitsurf
