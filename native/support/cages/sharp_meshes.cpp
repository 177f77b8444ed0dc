// SPDX-License-Identifier: Apache-2.0
#include "support/cages/sharp_meshes.h"

#include <algorithm>
#include <set>

namespace limitsurf::test {

std::vector<std::pair<int, int>> edgesOf(const Cage& cage) {
  std::set<std::pair<int, int>> edges;
  for (const std::vector<int>& face : cage.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      edges.insert(std::minmax(face[i], face[(i + 1) % face.size()]));
    }
  }
  return {edges.begin(), edges.end()};
}

void sharpenEdge(Cage& cage, int a, int b, double sharpness) {
  cage.options.edge_sharpness.edges.emplace_back(a, b);
  cage.options.edge_sharpness.values.push_back(sharpness);
}

void sharpenVertex(Cage& cage, int vertex, double sharpness) {
  cage.options.vertex_sharpness.vertices.push_back(vertex);
  cage.options.vertex_sharpness.values.push_back(sharpness);
}

void sharpenAtRandom(Cage& cage, Random& random, int edges_per_sharp, int vertices_per_sharp,
                     const std::vector<double>& values) {
  const auto value = [&] { return values[random.below(static_cast<int>(values.size()))]; };
  for (const auto& [a, b] : edgesOf(cage)) {
    if (random.below(edges_per_sharp) == 0) sharpenEdge(cage, a, b, value());
  }
  for (int v = 0; v < cage.vertexCount(); ++v) {
    if (random.below(vertices_per_sharp) == 0) sharpenVertex(cage, v, value());
  }
}

}  // namespace limitsurf::test
