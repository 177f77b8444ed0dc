// SPDX-License-Identifier: Apache-2.0
#include "support/cages/cage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

namespace limitsurf::test {

ControlMesh controlMesh(const Cage& cage) {
  std::vector<std::int64_t> sizes, vertices;
  for (const std::vector<int>& face : cage.faces) {
    sizes.push_back(static_cast<std::int64_t>(face.size()));
    vertices.insert(vertices.end(), face.begin(), face.end());
  }
  return ControlMesh(cage.positions, sizes, vertices, cage.options);
}

LimitSurface limitSurface(const Cage& cage) { return LimitSurface(controlMesh(cage)); }

double diagonal(const Points& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

std::vector<PtexFace> ptexFaces(const Cage& cage) {
  std::vector<PtexFace> result;
  for (int face = 0; face < static_cast<int>(cage.faces.size()); ++face) {
    const int size = static_cast<int>(cage.faces[face].size());
    if (size == 4) {
      result.push_back({face, 0, true});
    } else {
      for (int corner = 0; corner < size; ++corner) result.push_back({face, corner, false});
    }
  }
  return result;
}

bool isManifold(const std::vector<std::vector<int>>& faces) {
  std::map<std::pair<int, int>, int> face_of;   // directed edge -> face
  std::map<int, std::map<int, int>> successor;  // vertex -> (outgoing -> incoming) per face
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const std::vector<int>& face = faces[f];
    const int n = static_cast<int>(face.size());
    if (static_cast<int>(std::set<int>(face.begin(), face.end()).size()) != n) return false;
    for (int i = 0; i < n; ++i) {
      if (!face_of.emplace(std::make_pair(face[i], face[(i + 1) % n]), f).second) return false;
      successor[face[i]][face[(i + 1) % n]] = face[(i + n - 1) % n];
    }
  }
  for (const auto& [vertex, next] : successor) {
    // Walk the fan from its start (a spoke that no face enters), or from anywhere if it is closed.
    std::set<int> entered;
    for (const auto& link : next) entered.insert(link.second);
    int start = next.begin()->first;
    for (const auto& link : next) {
      if (entered.count(link.first) == 0) start = link.first;
    }
    std::size_t walked = 0;
    for (int spoke = start; next.count(spoke) != 0 && walked < next.size();) {
      ++walked;
      spoke = next.at(spoke);
      if (spoke == start) break;
    }
    if (walked != next.size()) return false;
  }
  return true;
}

Location cornerLocation(int face, int corner) {
  return {face, corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0};
}

std::string describe(const Location& location) {
  char text[120];
  std::snprintf(text, sizeof text, "face %d (u, v) = (%.17g, %.17g)", location.face, location.u,
                location.v);
  return text;
}

}  // namespace limitsurf::test
