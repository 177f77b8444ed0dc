// SPDX-License-Identifier: Apache-2.0
#include "support/truth/local_mesh.h"

#include <algorithm>
#include <utility>

namespace limitsurf::test {

Vector3 rounded(const Point& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

int LocalMesh::add(Vertex vertex) {
  vertices.push_back(std::move(vertex));
  sharp.emplace_back();
  return static_cast<int>(vertices.size()) - 1;
}

bool LocalMesh::settled() const {
  return std::all_of(faces[0].begin(), faces[0].end(), [&](int v) {
    std::vector<float> all = sharpnessAround(v);
    all.push_back(vertices[v].sharpness);
    return std::all_of(all.begin(), all.end(),
                       [](float s) { return s == 0 || isInfinitelySharp(s); });
  });
}

bool LocalMesh::regular() const {
  if (!settled()) return false;
  for (const std::vector<int>& face : faces) {
    if (face.size() != 4) return false;
  }
  return std::all_of(faces[0].begin(), faces[0].end(), [&](int v) {
    const Sector around = sector(0, v);
    switch (rule(v)) {
      case Rule::smooth:
        return around.faces == 4;
      case Rule::dart:
        return false;
      case Rule::crease:
        return around.faces == 2 && !around.closed && !vertices[v].loop;
      default:
        return around.faces == 1;
    }
  });
}

}  // namespace limitsurf::test
