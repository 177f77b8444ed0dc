// SPDX-License-Identifier: Apache-2.0
#include "support/cage.h"

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

FanSplit splitFans(const Cage& cage) {
  FanSplit split;
  split.faces = cage.faces;
  for (int v = 0; v < cage.vertexCount(); ++v) split.original.push_back(v);
  split.bow_tie.resize(cage.vertexCount(), false);

  struct Corner {
    int face, index, next, previous;
  };
  std::vector<std::vector<Corner>> corners(cage.vertexCount());
  for (int f = 0; f < static_cast<int>(cage.faces.size()); ++f) {
    const std::vector<int>& face = cage.faces[f];
    const int n = static_cast<int>(face.size());
    for (int i = 0; i < n; ++i) {
      corners[face[i]].push_back({f, i, face[(i + 1) % n], face[(i + n - 1) % n]});
    }
  }
  for (int v = 0; v < cage.vertexCount(); ++v) {
    std::vector<Corner> left = corners[v];
    for (int fan = 0; !left.empty(); ++fan) {
      const int vertex = fan == 0 ? v : static_cast<int>(split.original.size());
      if (fan > 0) {
        split.original.push_back(v);
        split.bow_tie.push_back(true);
        split.bow_tie[v] = true;
      }
      std::vector<Corner> connected = {left.back()};
      left.pop_back();
      while (!connected.empty()) {
        const Corner corner = connected.back();
        connected.pop_back();
        split.faces[corner.face][corner.index] = vertex;
        for (std::size_t i = 0; i < left.size();) {
          if (left[i].next == corner.previous || left[i].previous == corner.next) {
            connected.push_back(left[i]);
            left[i] = left.back();
            left.pop_back();
          } else {
            ++i;
          }
        }
      }
    }
  }
  return split;
}

CornerPoints::CornerPoints(const Cage& cage) {
  const FanSplit split = splitFans(cage);
  std::vector<int> face_count(split.original.size(), 0);
  std::set<std::pair<int, int>> directed;
  for (const std::vector<int>& face : split.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      ++face_count[face[i]];
      directed.emplace(face[i], face[(i + 1) % face.size()]);
    }
  }
  std::vector<bool> boundary(split.original.size(), false);
  for (const auto& [a, b] : directed) {
    if (directed.count({b, a}) == 0) boundary[a] = boundary[b] = true;
  }
  const bool corners = cage.options.boundary == Boundary::corners;
  const auto vertexPoint = [&](int vertex) {
    const bool pinned =
        split.bow_tie[vertex] || (corners && boundary[vertex] && face_count[vertex] == 1);
    return CornerPoint{boundary[vertex], face_count[vertex], split.original[vertex], pinned};
  };
  const auto edgePoint = [&](int a, int b) {
    const bool open = directed.count({b, a}) == 0 || directed.count({a, b}) == 0;
    return CornerPoint{open, open ? 2 : 4, -1, false};
  };
  for (const PtexFace& ptex : ptexFaces(cage)) {
    const std::vector<int>& face = split.faces[ptex.base_face];
    const int n = static_cast<int>(face.size());
    if (ptex.quad) {
      for (int vertex : face) corners_.push_back(vertexPoint(vertex));
    } else {
      const int vertex = face[ptex.corner];
      corners_.push_back(vertexPoint(vertex));
      corners_.push_back(edgePoint(vertex, face[(ptex.corner + 1) % n]));
      corners_.push_back(CornerPoint{false, n, -1, false});
      corners_.push_back(edgePoint(face[(ptex.corner + n - 1) % n], vertex));
    }
  }
}

const CornerPoint* CornerPoints::at(const Location& location) const {
  for (int corner = 0; corner < 4; ++corner) {
    const Location there = cornerLocation(location.face, corner);
    if (location.u == there.u && location.v == there.v) return &at(location.face, corner);
  }
  return nullptr;
}

bool CornerPoints::insideSmoothCorner(const Location& location) const {
  for (int corner = 0; corner < 4; ++corner) {
    const CornerPoint& point = at(location.face, corner);
    const Location there = cornerLocation(location.face, corner);
    const double distance =
        std::max(std::abs(location.u - there.u), std::abs(location.v - there.v));
    if (point.boundary && point.faces == 1 && !point.pinned && distance < 0x1p-20) return true;
  }
  return false;
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
