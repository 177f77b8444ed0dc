// SPDX-License-Identifier: Apache-2.0
#include "support/truth/sharp_topology.h"

#include <algorithm>
#include <stdexcept>

namespace limitsurf::test {

void SharpTopology::connect() {
  faces_of_vertex.resize(sharp.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      const int a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
      if (!face_of_directed_edge.emplace(std::make_pair(a, b), f).second) {
        throw std::logic_error("edge used twice in one direction");
      }
      faces_of_vertex[a].push_back(f);
    }
  }
}

int SharpTopology::faceAt(int a, int b) const {
  const auto found = face_of_directed_edge.find({a, b});
  return found == face_of_directed_edge.end() ? -1 : found->second;
}

std::pair<int, int> SharpTopology::neighbours(int face, int v) const {
  const std::vector<int>& around = faces[face];
  const std::size_t n = around.size();
  const std::size_t i = std::find(around.begin(), around.end(), v) - around.begin();
  return {around[(i + 1) % n], around[(i + n - 1) % n]};
}

float SharpTopology::sharpness(int a, int b) const {
  // Where a crease leads on into another fan of faces, only one of the ends knows of it.
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
    for (const Spoke& spoke : sharp[from]) {
      if (spoke.to == to) return spoke.sharpness;
    }
  }
  return 0;
}

std::vector<float> SharpTopology::sharpnessAround(int v) const {
  std::vector<float> result;
  for (const Spoke& spoke : sharp[v]) {
    if (spoke.again < 0) result.push_back(spoke.sharpness);
  }
  return result;
}

SharpTopology::Sector SharpTopology::sector(int face, int v) const {
  Sector result = {1, false};
  for (const bool counter_clockwise : {true, false}) {
    for (int at = face;; ++result.faces) {
      const auto [next, previous] = neighbours(at, v);
      const int spoke = counter_clockwise ? previous : next;
      if (isOpen(v, spoke)) break;
      at = counter_clockwise ? faceAt(v, spoke) : faceAt(spoke, v);
      if (at < 0) throw std::logic_error("vertex at the cut of the mesh");
      if (at == face) {
        result.closed = true;
        return result;
      }
    }
  }
  return result;
}

}  // namespace limitsurf::test
