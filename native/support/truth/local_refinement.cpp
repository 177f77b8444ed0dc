// SPDX-License-Identifier: Apache-2.0
#include "support/truth/local_refinement.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace limitsurf::test {
namespace {

std::pair<int, int> undirected(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

class Refinement {
 public:
  Refinement(const LocalMesh& parent, const MeshOptions& options)
      : parent_(parent), options_(options) {}

  LocalMesh child(int corner, bool keep_uv) {
    const std::vector<int>& face = parent_.faces[0];
    const int n = static_cast<int>(face.size());
    const int vertex = face[corner], next = face[(corner + 1) % n],
              previous = face[(corner + n - 1) % n];
    addChild(0, vertex);
    if (keep_uv) {
      std::vector<int>& first = child_.faces[0];
      std::rotate(first.begin(), first.begin() + (4 - corner) % 4, first.end());
    }
    for (int other : face) addChild(0, other);
    for (int around : parent_.faces_of_vertex[vertex]) addChild(around, vertex);
    if (const int across = parent_.faceAt(next, vertex); across >= 0) addChild(across, next);
    if (const int across = parent_.faceAt(vertex, previous); across >= 0) {
      addChild(across, previous);
    }
    for (const Spoke& spoke : parent_.sharp[vertex]) {
      if (isInfinitelySharp(spoke.sharpness)) edgePoint(vertex, spoke.to);
    }
    joinSpokes();
    moveOrigin(child_.vertices[vertex_points_.at(vertex)].point);
    child_.connect();
    return std::move(child_);
  }

 private:
  void addChild(int f, int vertex) {
    if (!added_.insert({f, vertex}).second) return;
    const auto [next, previous] = parent_.neighbours(f, vertex);
    const int corner = vertexPoint(vertex), next_edge = edgePoint(vertex, next),
              centre = facePoint(f), previous_edge = edgePoint(previous, vertex);
    child_.faces.push_back({corner, next_edge, centre, previous_edge});
  }

  const Point& at(int vertex) const { return parent_.vertices[vertex].point; }

  /// The mean of the face's vertices.
  const Point& centre(int f) {
    const auto [found, is_new] = centres_.emplace(f, Point());
    if (is_new) {
      for (int vertex : parent_.faces[f]) found->second += at(vertex);
      found->second = (Real(1) / static_cast<int>(parent_.faces[f].size())) * found->second;
    }
    return found->second;
  }

  int facePoint(int f) {
    const auto [found, is_new] = face_points_.emplace(f, 0);
    if (is_new) {
      found->second = child_.add({centre(f), static_cast<int>(parent_.faces[f].size()), 0});
    }
    return found->second;
  }

  std::vector<float> childSharpnessAround(int v) const {
    return childSharpness(parent_.sharpnessAround(v), options_.creasing);
  }

  /// What remains of the sharpness of an edge at its end `a`.
  float childSharpnessAt(int a, int b) const {
    const float sharpness = parent_.sharpness(a, b);
    if (sharpness == 0 || isInfinitelySharp(sharpness)) return sharpness;
    const std::vector<Spoke>& around = parent_.sharp[a];
    const auto spoke =
        std::find_if(around.begin(), around.end(), [&](const Spoke& s) { return s.to == b; });
    return childSharpnessAround(a).at(spoke - around.begin());
  }

  Point smoothEdgePoint(int a, int b) {
    const int left = parent_.faceAt(a, b), right = parent_.faceAt(b, a);
    if (left < 0 || right < 0) throw std::logic_error("edge at the cut of the local mesh");
    // A quarter each for ends and face centres; beside triangles, the smooth triangle rule gives
    // the face centres 0.47 and the ends what remains.
    const auto weight = [&](int f) {
      const bool triangle = parent_.faces[f].size() == 3;
      return options_.triangles == Triangles::smooth && triangle ? Real(0.47) : Real(0.25);
    };
    const Real face_weight = (weight(left) + weight(right)) / 2;
    const Real end_weight = Real(0.5) - face_weight;
    return end_weight * (at(a) + at(b)) + face_weight * (centre(left) + centre(right));
  }

  /// Sharp edges have their middle; from sharpness 1 to 0, that is mixed with the smooth point.
  Point edgePosition(int a, int b, float at_a, float at_b) {
    const float sharpness = parent_.sharpness(a, b);
    const Point middle = Real(0.5) * (at(a) + at(b));
    const bool stays_sharp = options_.creasing == Creasing::chaikin && at_a > 0 && at_b > 0;
    if (sharpness >= 1 || stays_sharp) return middle;
    if (sharpness == 0) return smoothEdgePoint(a, b);
    return Real(sharpness) * middle + (1 - Real(sharpness)) * smoothEdgePoint(a, b);
  }

  int edgePoint(int a, int b) {
    const auto [found, is_new] = edge_points_.emplace(undirected(a, b), 0);
    if (!is_new) return found->second;
    const float at_a = childSharpnessAt(a, b), at_b = childSharpnessAt(b, a);
    const int faces = (parent_.faceAt(a, b) >= 0) + (parent_.faceAt(b, a) >= 0);
    return found->second = child_.add({edgePosition(a, b, at_a, at_b), 2 * faces, 0});
  }

  /// The rules in their pure form, `edges` being sharp.
  Point vertexPosition(int v, Rule rule, const std::vector<float>& edges) {
    const LocalMesh::Vertex& vertex = parent_.vertices[v];
    const std::vector<int>& around = parent_.faces_of_vertex[v];
    if (rule == Rule::corner) return vertex.point;
    if (rule == Rule::crease) {
      Point moved = Real(0.75) * vertex.point;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i] > 0) moved += Real(0.125) * at(parent_.sharp[v].at(i).to);
      }
      return moved;
    }
    const int n = vertex.faces;
    if (static_cast<int>(around.size()) != n) {
      throw std::logic_error("vertex at the cut of the local mesh");
    }
    Point sum;
    for (int f : around) sum += centre(f) + at(parent_.neighbours(f, v).first);
    return (Real(n - 2) / n) * vertex.point + (Real(1) / (n * n)) * sum;
  }

  /// The parent's rule; where its child's differs, a mixture of both.
  int vertexPoint(int v) {
    const auto [found, is_new] = vertex_points_.emplace(v, 0);
    if (!is_new) return found->second;
    const LocalMesh::Vertex& old = parent_.vertices[v];
    const std::vector<float> edges = parent_.sharpnessAround(v);
    const std::vector<float> child_edges = childSharpnessAround(v);
    const float child_sharpness = decayed(old.sharpness);
    const Rule rule = parent_.rule(v), child_rule = vertexRule(child_sharpness, child_edges);
    Point moved = vertexPosition(v, rule, edges);
    if (rule != child_rule && rule != Rule::smooth && rule != Rule::dart) {
      const Real share = parentsShare(old.sharpness, edges, child_edges, options_.creasing);
      moved = share * moved + (1 - share) * vertexPosition(v, child_rule, child_edges);
    }
    return found->second = child_.add({moved, old.faces, child_sharpness, old.loop});
  }

  /// Tells every new vertex of its sharp edges.
  void joinSpokes() {
    const auto known = [](const auto& points, const auto& key) {
      const auto found = points.find(key);
      return found == points.end() ? -1 : found->second;
    };
    for (const auto& [v, point] : vertex_points_) {
      const std::vector<float> edges = childSharpnessAround(v);
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i] == 0) continue;
        const int other = parent_.sharp[v][i].to;
        child_.sharp[point].push_back({known(edge_points_, undirected(v, other)), edges[i]});
      }
      for (const Spoke& spoke : parent_.sharp[v]) {
        if (spoke.again < 0) continue;
        const int to = known(edge_points_, undirected(v, spoke.to));
        const int again = known(edge_points_, undirected(v, spoke.again));
        if (again >= 0) child_.sharp[point].push_back({to, spoke.sharpness, again});
      }
    }
    for (const auto& [ends, point] : edge_points_) {
      const auto [a, b] = ends;
      const float at_a = childSharpnessAt(a, b), at_b = childSharpnessAt(b, a);
      if (at_a > 0) child_.sharp[point].push_back({known(vertex_points_, a), at_a});
      if (at_b > 0) child_.sharp[point].push_back({known(vertex_points_, b), at_b});
    }
  }

  /// Keeps coordinates as small as the neighbourhood itself, so that deep levels lose no digits.
  void moveOrigin(Point to) {
    child_.origin = parent_.origin + to;
    for (LocalMesh::Vertex& vertex : child_.vertices) vertex.point = vertex.point - to;
  }

  const LocalMesh& parent_;
  const MeshOptions& options_;
  LocalMesh child_;
  std::set<std::pair<int, int>> added_;
  std::map<int, Point> centres_;
  std::map<int, int> face_points_, vertex_points_;
  std::map<std::pair<int, int>, int> edge_points_;
};

}  // namespace

LocalMesh refined(const LocalMesh& parent, const MeshOptions& options, int corner, bool keep_uv) {
  return Refinement(parent, options).child(corner, keep_uv);
}

}  // namespace limitsurf::test
