// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/value_vertices.h"

#include <map>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

ValueVertices::ValueVertices(const ControlMesh& mesh, const Topology& topology,
                             const std::vector<std::int64_t>& indices) {
  const auto& level = topology.level();
  at_corner.resize(indices.size());
  std::map<int, std::vector<int>> non_manifold_corners;
  for (std::size_t corner = 0; corner < indices.size(); ++corner) {
    const int vertex = mesh.faceVertices()[corner];
    if (level.IsVertexNonManifold(vertex)) {
      non_manifold_corners[vertex].push_back(static_cast<int>(corner));
    }
  }
  std::vector<int> corners;
  InterruptionStride stride;
  for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
    stride.step();
    first.push_back(static_cast<int>(values.size()));
    if (level.IsVertexNonManifold(vertex)) {
      number(indices, non_manifold_corners[vertex], false);
      continue;
    }
    const auto around = level.GetVertexFaces(vertex);
    const auto places = level.GetVertexFaceLocalIndices(vertex);
    corners.clear();
    for (int i = 0; i < around.size(); ++i) {
      corners.push_back(mesh.firstCorner(around[i]) + places[i]);
    }
    number(indices, corners, true);
  }
  first.push_back(static_cast<int>(values.size()));
}

/// Makes the vertices of the values at the corners of one vertex. `in_order`: whether successive
/// corners are neighbours around the vertex. OpenSubdiv (3.0 to 3.6) then counts the second value
/// that it meets again, as a third one, where that value returns before any third one.
void ValueVertices::number(const std::vector<std::int64_t>& indices,
                           const std::vector<int>& corners, bool in_order) {
  const int first_here = first.back();
  std::map<std::int64_t, int> known;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::int64_t value = indices[corners[i]];
    if (i > 0 && value == indices[corners[i - 1]]) {
      at_corner[corners[i]] = at_corner[corners[i - 1]];
    } else {
      const int next = static_cast<int>(values.size());
      const auto [place, is_new] = known.try_emplace(value, next);
      const bool again = in_order && next - first_here == 2 && place->second == first_here + 1;
      at_corner[corners[i]] = again ? next : place->second;
      if (is_new || again) {
        values.push_back(static_cast<int>(value));
        faces.push_back(0);
      }
    }
    ++faces[at_corner[corners[i]]];
  }
}

}  // namespace limitsurf
