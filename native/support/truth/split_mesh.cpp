// SPDX-License-Identifier: Apache-2.0
#include "support/truth/split_mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "support/truth/sharpness.h"

namespace limitsurf::test {
namespace {

struct Edge {
  int forward = 0, backward = 0;  ///< faces by direction, forward being from the lower end
  float sharpness = 0;

  int faces() const { return forward + backward; }
  bool manifold() const { return faces() == 1 || (forward == 1 && backward == 1); }
};

/// A vertex in one of its faces, which leads from `previous` by it to `next`.
struct Corner {
  int face, index, next, previous;
};

/// Corners in counter-clockwise order.
struct Fan {
  std::vector<Corner> corners;
  bool closed;
};

class Splitter {
 public:
  Splitter(const Cage& cage, SplitMesh& split) : cage_(cage), split_(split) {
    corners_.resize(cage.vertexCount());
    for (int f = 0; f < static_cast<int>(cage.faces.size()); ++f) addFace(f);
    sharpenEdges();
    split_.faces = cage.faces;
    for (int v = 0; v < cage.vertexCount(); ++v) addFans(v);
    for (int v = 0; v < cage.vertexCount(); ++v) sharpen(v);
  }

 private:
  void addFace(int f) {
    const std::vector<int>& face = cage_.faces[f];
    const int n = static_cast<int>(face.size());
    if (std::set<int>(face.begin(), face.end()).size() != face.size()) {
      throw std::logic_error("a face uses a vertex twice");
    }
    for (int i = 0; i < n; ++i) {
      const int vertex = face[i], next = face[(i + 1) % n], previous = face[(i + n - 1) % n];
      corners_[vertex].push_back({f, i, next, previous});
      Edge& edge = edges_[std::minmax(vertex, next)];
      ++(vertex < next ? edge.forward : edge.backward);
    }
  }

  Edge& edge(int a, int b) { return edges_.at(std::minmax(a, b)); }

  void sharpenEdges() {
    const EdgeSharpness& given = cage_.options.edge_sharpness;
    for (std::size_t i = 0; i < given.edges.size(); ++i) {
      edge(static_cast<int>(given.edges[i].first), static_cast<int>(given.edges[i].second))
          .sharpness = enteredSharpness(given.values[i]);
    }
    for (auto& [ends, edge] : edges_) {
      if (edge.faces() != 2 || !edge.manifold()) edge.sharpness = kInfinitelySharp;
    }
  }

  /// Splits the corners of a vertex where the edge between them has not two faces of equal winding.
  void addFans(int v) {
    std::map<int, int> beginning_at;  // next vertex -> corner
    std::set<int> continued;
    const std::vector<Corner>& corners = corners_[v];
    const int count = static_cast<int>(corners.size());
    const auto connects = [&](int other) {
      return edge(v, other).faces() == 2 && edge(v, other).manifold();
    };
    for (int i = 0; i < count; ++i) {
      if (connects(corners[i].next)) beginning_at[corners[i].next] = i;
    }
    for (const Corner& corner : corners) {
      const auto after = beginning_at.find(corner.previous);
      if (after != beginning_at.end()) continued.insert(after->second);
    }
    fans_.emplace_back();
    std::set<int> used;
    for (const bool closed : {false, true}) {
      for (int i = 0; i < count; ++i) {
        if (used.count(i) != 0 || (!closed && continued.count(i) != 0)) continue;
        Fan fan{{}, closed};
        for (int at = i; used.insert(at).second;) {
          fan.corners.push_back(corners[at]);
          const auto after = beginning_at.find(corners[at].previous);
          if (after != beginning_at.end()) at = after->second;
        }
        addVertex(v, std::move(fan));
      }
    }
  }

  void addVertex(int v, Fan fan) {
    const int added = static_cast<int>(split_.vertices.size());
    for (const Corner& corner : fan.corners) split_.faces[corner.face][corner.index] = added;
    const bool loop = !fan.closed && fan.corners.front().next == fan.corners.back().previous;
    split_.vertices.push_back({v, static_cast<int>(fan.corners.size()), 0, loop});
    split_.sharp.emplace_back();
    copies_[v].push_back(added);
    fans_.back().push_back(std::move(fan));
  }

  void sharpen(int v) {
    const std::set<int> around = neighbours(v);
    const float sharpness = vertexSharpness(v, around);
    for (std::size_t i = 0; i < fans_[v].size(); ++i) {
      const int vertex = copies_[v][i];
      split_.vertices[vertex].sharpness = sharpness;
      std::vector<Spoke> again;
      for (int other : around) {
        const float edge_sharpness = edge(v, other).sharpness;
        if (edge_sharpness == 0) continue;
        std::set<int> ends = endsIn(fans_[v][i], other);
        if (ends.empty()) {
          // The other end's place matters where it is the end of a crease, that is for ever.
          ends.insert(isInfinitelySharp(edge_sharpness) ? copies_.at(other)[0] : -1);
        }
        const int first = *ends.begin();
        split_.sharp[vertex].push_back({first, edge_sharpness});
        for (int end : ends) {
          if (end != first) again.push_back({end, edge_sharpness, first});
        }
      }
      split_.sharp[vertex].insert(split_.sharp[vertex].end(), again.begin(), again.end());
    }
  }

  bool manifold(int v) {
    return fans_[v].size() == 1 &&
           std::all_of(corners_[v].begin(), corners_[v].end(), [&](const Corner& corner) {
             return edge(v, corner.next).manifold() && edge(v, corner.previous).manifold();
           });
  }

  std::set<int> neighbours(int v) const {
    std::set<int> result;
    for (const Corner& corner : corners_[v]) result.insert({corner.next, corner.previous});
    return result;
  }

  float vertexSharpness(int v, const std::set<int>& around) {
    const int faces = static_cast<int>(corners_[v].size()), edges = static_cast<int>(around.size());
    if (cage_.options.boundary == Boundary::corners && faces == 1) return kInfinitelySharp;
    if (faces > 0 && !manifold(v)) {
      int crease_edges = 0, boundary_edges = 0;
      for (int other : around) {
        crease_edges += !edge(v, other).manifold();
        boundary_edges += edge(v, other).faces() == 1;
      }
      const bool crease = crease_edges == 2 && boundary_edges == 0 && faces > edges;
      if (!crease) return kInfinitelySharp;
    }
    const VertexSharpness& given = cage_.options.vertex_sharpness;
    float result = 0;
    for (std::size_t i = 0; i < given.vertices.size(); ++i) {
      if (given.vertices[i] == v) result = enteredSharpness(given.values[i]);
    }
    return result;
  }

  /// What a neighbour became in the fan's faces.
  std::set<int> endsIn(const Fan& fan, int other) const {
    std::set<int> result;
    for (const Corner& corner : fan.corners) {
      const std::vector<int>& face = split_.faces[corner.face];
      const int n = static_cast<int>(face.size());
      if (corner.next == other) result.insert(face[(corner.index + 1) % n]);
      if (corner.previous == other) result.insert(face[(corner.index + n - 1) % n]);
    }
    return result;
  }

  const Cage& cage_;
  SplitMesh& split_;
  std::map<std::pair<int, int>, Edge> edges_;
  std::vector<std::vector<Corner>> corners_;  // by vertex, in the order of the faces
  std::vector<std::vector<Fan>> fans_;        // by vertex
  std::map<int, std::vector<int>> copies_;    // vertex -> one for each of its fans
};

}  // namespace

SplitMesh::SplitMesh(const Cage& cage) {
  Splitter(cage, *this);
  connect();
}

}  // namespace limitsurf::test
