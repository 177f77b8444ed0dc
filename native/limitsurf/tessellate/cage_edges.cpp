// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/tessellate/cage_edges.h"

#include <algorithm>

namespace limitsurf {

CageEdges::CageEdges(const ControlMesh& mesh) : of_corner(mesh.faceVertices().size()) {
  // Corners are sorted by the smaller vertex of their edge, then by the larger one.
  std::vector<int> larger(of_corner.size()),
      starts(static_cast<std::size_t>(mesh.vertexCount()) + 1);
  std::vector<int> smaller(of_corner.size());
  for (int face = 0; face < mesh.faceCount(); ++face) {
    const Span<int> vertices = mesh.faceVertices(face);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const auto [low, high] = std::minmax(vertices[k], vertices[(k + 1) % vertices.size()]);
      const std::size_t corner = static_cast<std::size_t>(mesh.firstCorner(face)) + k;
      smaller[corner] = low;
      larger[corner] = high;
      ++starts[static_cast<std::size_t>(low) + 1];
    }
  }
  for (std::size_t vertex = 1; vertex < starts.size(); ++vertex) {
    starts[vertex] += starts[vertex - 1];
  }
  std::vector<int> corners(of_corner.size()), end = starts;
  for (std::size_t corner = 0; corner < of_corner.size(); ++corner) {
    corners[end[smaller[corner]]++] = static_cast<int>(corner);
  }
  for (std::size_t vertex = 0; vertex + 1 < starts.size(); ++vertex) {
    const auto first = corners.begin() + starts[vertex], last = corners.begin() + end[vertex];
    std::sort(first, last,
              [&](int a, int b) { return larger[a] != larger[b] ? larger[a] < larger[b] : a < b; });
    for (auto corner = first; corner != last; ++corner) {
      count += corner == first || larger[*corner] != larger[*(corner - 1)];
      of_corner[*corner] = count - 1;
    }
  }
}

}  // namespace limitsurf
