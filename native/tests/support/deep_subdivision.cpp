// SPDX-License-Identifier: Apache-2.0
#include "support/deep_subdivision.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace limitsurf::test {
namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::cpp_bin_float<50>, mp::et_off>;

struct Point {
  Real x = 0, y = 0, z = 0;

  Point& operator+=(const Point& p) {
    x += p.x, y += p.y, z += p.z;
    return *this;
  }
};
Point operator+(Point a, const Point& b) { return a += b; }
Point operator*(const Real& s, const Point& p) { return {s * p.x, s * p.y, s * p.z}; }
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Vector3 rounded(const Point& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

using Edge = std::pair<int, int>;
Edge undirected(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// A vertex of a local mesh, with what is known of it in the whole mesh.
struct Vertex {
  Point point;  ///< relative to the local mesh's origin
  int faces;    ///< around it in the whole mesh
  bool boundary;
  bool pinned;
};

/// A face (the first) and all faces that share a vertex with it.
///
/// Its vertices' own neighbourhoods are complete; elsewhere the local mesh is cut off, so that an
/// edge with a single face here is a boundary of the whole mesh only if it is listed as one.
struct LocalMesh {
  Point origin;
  std::vector<Vertex> vertices;
  std::vector<std::vector<int>> faces;
  std::set<Edge> boundary_edges;

  // Adjacency, by connect().
  std::map<Edge, int> face_of_directed_edge;
  std::vector<std::vector<int>> faces_of_vertex;

  void connect() {
    faces_of_vertex.resize(vertices.size());
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
      for (std::size_t i = 0; i < faces[f].size(); ++i) {
        const int a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
        if (!face_of_directed_edge.emplace(Edge(a, b), f).second) {
          throw std::logic_error("edge used twice in one direction");
        }
        faces_of_vertex[a].push_back(f);
      }
    }
  }

  bool isBoundary(int a, int b) const { return boundary_edges.count(undirected(a, b)) != 0; }

  int neighbour(int a, int b) const {
    const auto found = face_of_directed_edge.find({a, b});
    return found == face_of_directed_edge.end() ? -1 : found->second;
  }

  /// The face that has the directed edge, its vertices rotated to begin with it; empty if none.
  std::vector<int> faceFrom(int a, int b) const {
    const int f = neighbour(a, b);
    if (f < 0) return {};
    std::vector<int> face = faces[f];
    std::rotate(face.begin(), std::find(face.begin(), face.end(), a), face.end());
    return face;
  }

  /// Whether the first face is a bicubic B-spline patch.
  bool regular() const {
    for (const std::vector<int>& face : faces) {
      if (face.size() != 4) return false;
    }
    return std::all_of(faces[0].begin(), faces[0].end(), [&](int v) {
      const Vertex& vertex = vertices[v];
      return vertex.faces == (!vertex.boundary ? 4 : vertex.pinned ? 1 : 2);
    });
  }
};

/// One step of Catmull-Clark subdivision of the part of a local mesh that matters to the child of
/// its first face at a corner.
class Refinement {
 public:
  Refinement(const LocalMesh& parent, bool smooth_triangles)
      : parent_(parent), smooth_triangles_(smooth_triangles) {}

  /// The child's vertices begin with the parent's corner and turn with the face; with `keep_uv`
  /// (quads) they are in the parent's parametric order instead.
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
    if (const int across = parent_.neighbour(next, vertex); across >= 0) addChild(across, next);
    if (const int across = parent_.neighbour(vertex, previous); across >= 0) {
      addChild(across, previous);
    }
    moveOrigin(child_.vertices[vertex_points_.at(vertex)].point);
    child_.connect();
    return std::move(child_);
  }

 private:
  void addChild(int f, int vertex) {
    if (!added_.insert({f, vertex}).second) return;
    const std::vector<int>& face = parent_.faces[f];
    const int n = static_cast<int>(face.size());
    const int i = static_cast<int>(std::find(face.begin(), face.end(), vertex) - face.begin());
    const int next = face[(i + 1) % n], previous = face[(i + n - 1) % n];
    const int corner = vertexPoint(vertex);
    const int next_edge = edgePoint(vertex, next), previous_edge = edgePoint(previous, vertex);
    child_.faces.push_back({corner, next_edge, facePoint(f), previous_edge});
    if (parent_.isBoundary(vertex, next)) {
      child_.boundary_edges.insert(undirected(corner, next_edge));
    }
    if (parent_.isBoundary(previous, vertex)) {
      child_.boundary_edges.insert(undirected(corner, previous_edge));
    }
  }

  int add(Vertex vertex) {
    child_.vertices.push_back(std::move(vertex));
    return static_cast<int>(child_.vertices.size()) - 1;
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
      found->second = add({centre(f), static_cast<int>(parent_.faces[f].size()), false, false});
    }
    return found->second;
  }

  int edgePoint(int a, int b) {
    const auto [found, is_new] = edge_points_.emplace(undirected(a, b), 0);
    if (!is_new) return found->second;
    if (parent_.isBoundary(a, b)) {
      return found->second = add({Real(0.5) * (at(a) + at(b)), 2, true, false});
    }
    const int left = parent_.neighbour(a, b), right = parent_.neighbour(b, a);
    if (left < 0 || right < 0) throw std::logic_error("edge at the cut of the local mesh");
    // A quarter each for ends and face centres; beside triangles, the smooth triangle rule gives
    // the face centres 0.47 and the ends what remains.
    const auto weight = [&](int f) {
      return smooth_triangles_ && parent_.faces[f].size() == 3 ? Real(0.47) : Real(0.25);
    };
    const Real face_weight = (weight(left) + weight(right)) / 2;
    const Real end_weight = Real(0.5) - face_weight;
    return found->second =
               add({end_weight * (at(a) + at(b)) + face_weight * (centre(left) + centre(right)), 4,
                    false, false});
  }

  int vertexPoint(int v) {
    const auto [found, is_new] = vertex_points_.emplace(v, 0);
    if (!is_new) return found->second;
    const Vertex& old = parent_.vertices[v];
    const std::vector<int>& around = parent_.faces_of_vertex[v];
    if (static_cast<int>(around.size()) != old.faces) {
      throw std::logic_error("vertex at the cut of the local mesh");
    }
    Point moved = old.point;
    if (old.boundary && !old.pinned) {
      moved = Real(0.75) * old.point;
      for (int f : around) {
        for (int other : spokes(f, v)) {
          if (parent_.isBoundary(v, other)) moved += Real(0.125) * at(other);
        }
      }
    } else if (!old.boundary) {
      const int n = old.faces;
      Point sum;
      for (int f : around) sum += centre(f) + at(spokes(f, v)[0]);
      moved = (Real(n - 2) / n) * old.point + (Real(1) / (n * n)) * sum;
    }
    return found->second = add({moved, old.faces, old.boundary, old.pinned});
  }

  /// The vertices after and before `v` in a face.
  std::array<int, 2> spokes(int f, int v) const {
    const std::vector<int>& face = parent_.faces[f];
    const std::size_t n = face.size();
    const std::size_t i = std::find(face.begin(), face.end(), v) - face.begin();
    return {face[(i + 1) % n], face[(i + n - 1) % n]};
  }

  /// Keeps coordinates as small as the neighbourhood itself, so that deep levels lose no digits.
  void moveOrigin(Point to) {
    child_.origin = parent_.origin + to;
    for (Vertex& vertex : child_.vertices) vertex.point = vertex.point - to;
  }

  const LocalMesh& parent_;
  const bool smooth_triangles_;
  LocalMesh child_;
  std::set<std::pair<int, int>> added_;
  std::map<int, Point> centres_;
  std::map<int, int> face_points_, vertex_points_;
  std::map<Edge, int> edge_points_;
};

/// The 4x4 control points around a regular face, [v][u], the missing ones beyond a boundary
/// extrapolated.
using Grid = std::array<std::array<Point, 4>, 4>;

Grid gridAround(const LocalMesh& mesh) {
  // Grid coordinates of the face's corners; beyond corner k lies outer[k].
  constexpr int inner[4][2] = {{1, 1}, {2, 1}, {2, 2}, {1, 2}};
  constexpr int outer[4][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}};
  const std::vector<int>& face = mesh.faces[0];
  Grid grid;
  const auto cell = [&](int i, int j) -> Point& { return grid[j][i]; };
  const auto point = [&](int vertex) { return mesh.vertices[vertex].point; };
  const auto mirrored = [](const Point& at, const Point& in) { return Real(2) * at - in; };

  for (int k = 0; k < 4; ++k) cell(inner[k][0], inner[k][1]) = point(face[k]);
  bool open[4];
  for (int k = 0; k < 4; ++k) {  // beyond the side from corner k to corner l
    const int l = (k + 1) % 4;
    const int step_i = inner[k][0] - inner[(k + 3) % 4][0];
    const int step_j = inner[k][1] - inner[(k + 3) % 4][1];
    Point& beyond_k = cell(inner[k][0] + step_i, inner[k][1] + step_j);
    Point& beyond_l = cell(inner[l][0] + step_i, inner[l][1] + step_j);
    const std::vector<int> across = mesh.faceFrom(face[l], face[k]);
    open[k] = across.empty();
    if (open[k]) {
      if (!mesh.isBoundary(face[k], face[l])) throw std::logic_error("side at the cut");
      beyond_k = mirrored(point(face[k]), point(face[(k + 3) % 4]));
      beyond_l = mirrored(point(face[l]), point(face[(l + 1) % 4]));
    } else {
      beyond_k = point(across[2]);
      beyond_l = point(across[3]);
    }
  }
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    const int oi = outer[k][0], oj = outer[k][1], ii = inner[k][0], ij = inner[k][1];
    Point& corner = cell(oi, oj);
    if (!open[before] && !open[k]) {
      const int spoke = mesh.faceFrom(face[k], face[before])[3];
      corner = point(mesh.faceFrom(face[k], spoke).at(2));
    } else if (!open[before] || !open[k]) {
      // Along the row beyond the side that is not open, over the one that is.
      const bool row = (k % 2 == 0) == open[before];  // whether the row runs in u
      corner = row ? mirrored(cell(ii, oj), cell(2 * ii - oi, oj))
                   : mirrored(cell(oi, ij), cell(oi, 2 * ij - oj));
    } else {
      corner = mirrored(cell(ii, oj), cell(2 * ii - oi, oj));
    }
  }
  return grid;
}

/// Values of the four uniform cubic B-splines at t, or their first or second derivatives.
std::array<Real, 4> splines(const Real& t, int derivative) {
  const Real s = 1 - t;
  switch (derivative) {
    case 0:
      return {s * s * s / 6, (t * t * (3 * t - 6) + 4) / 6, (s * s * (3 * s - 6) + 4) / 6,
              t * t * t / 6};
    case 1:
      return {-s * s / 2, t * (3 * t - 4) / 2, -s * (3 * s - 4) / 2, t * t / 2};
    default:
      return {s, 3 * t - 2, 1 - 3 * t, t};
  }
}

Point evaluate(const Grid& grid, const Real& u, const Real& v, int du, int dv) {
  const std::array<Real, 4> bu = splines(u, du), bv = splines(v, dv);
  Point sum;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) sum += (bu[i] * bv[j]) * grid[j][i];
  }
  return sum;
}

/// A refined face: either a patch, or an irregular face with those of its children that were asked
/// for so far.
struct Node {
  LocalMesh mesh;
  bool regular;
  Grid grid;
  std::array<std::unique_ptr<Node>, 4> children;

  explicit Node(LocalMesh m) : mesh(std::move(m)), regular(mesh.regular()) {
    if (regular) grid = gridAround(mesh);
  }
};

}  // namespace

struct DeepSubdivision::Data {
  Cage cage;
  FanSplit split;
  bool smooth_triangles;
  std::vector<PtexFace> ptex;
  std::vector<std::vector<int>> faces_of_vertex;
  std::set<Edge> boundary_edges;
  std::set<int> boundary_vertices;
  std::map<int, std::unique_ptr<Node>> roots;

  LocalMesh neighbourhood(int base_face) const {
    std::vector<int> faces = {base_face};
    for (int vertex : split.faces[base_face]) {
      for (int face : faces_of_vertex[vertex]) {
        if (std::find(faces.begin(), faces.end(), face) == faces.end()) faces.push_back(face);
      }
    }
    LocalMesh mesh;
    std::map<int, int> local;
    for (int face : faces) {
      const std::vector<int>& global = split.faces[face];
      std::vector<int> vertices;
      for (int vertex : global) {
        const auto [found, is_new] = local.emplace(vertex, static_cast<int>(mesh.vertices.size()));
        if (is_new) {
          const int count = static_cast<int>(faces_of_vertex[vertex].size());
          const bool boundary = boundary_vertices.count(vertex) != 0;
          const bool corner = boundary && count == 1 && cage.options.boundary == Boundary::corners;
          const bool pinned = corner || split.bow_tie[vertex];
          const auto p = cage.positions.row(split.original[vertex]);
          mesh.vertices.push_back({{p[0], p[1], p[2]}, count, boundary, pinned});
        }
        vertices.push_back(found->second);
      }
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::size_t next = (i + 1) % vertices.size();
        if (boundary_edges.count(undirected(global[i], global[next])) != 0) {
          mesh.boundary_edges.insert(undirected(vertices[i], vertices[next]));
        }
      }
      mesh.faces.push_back(std::move(vertices));
    }
    mesh.connect();
    return mesh;
  }

  Node& root(int face) {
    std::unique_ptr<Node>& node = roots[face];
    if (!node) {
      LocalMesh mesh = neighbourhood(ptex.at(face).base_face);
      if (!ptex[face].quad) {
        mesh = Refinement(mesh, smooth_triangles).child(ptex[face].corner, false);
      }
      node = std::make_unique<Node>(std::move(mesh));
    }
    return *node;
  }
};

DeepSubdivision::DeepSubdivision(const Cage& cage) : data_(std::make_unique<Data>()) {
  data_->cage = cage;
  data_->split = splitFans(cage);
  data_->smooth_triangles = cage.options.triangles == Triangles::smooth;
  data_->ptex = ptexFaces(cage);
  data_->faces_of_vertex.resize(data_->split.original.size());
  std::set<Edge> directed;
  for (int f = 0; f < static_cast<int>(cage.faces.size()); ++f) {
    const std::vector<int>& face = data_->split.faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      data_->faces_of_vertex[face[i]].push_back(f);
      directed.emplace(face[i], face[(i + 1) % face.size()]);
    }
  }
  for (const auto& [a, b] : directed) {
    if (directed.count({b, a}) != 0) continue;
    data_->boundary_edges.insert(undirected(a, b));
    data_->boundary_vertices.insert(a);
    data_->boundary_vertices.insert(b);
  }
}

DeepSubdivision::~DeepSubdivision() = default;

Truth DeepSubdivision::evaluate(const Location& at) {
  Node* node = &data_->root(at.face);
  double u = at.u, v = at.v;
  int level = 0;
  while (!node->regular) {
    if (++level > 1200) throw std::runtime_error("irregular vertex at " + describe(at));
    const bool high_u = u >= 0.5, high_v = v >= 0.5;
    const int corner = high_v ? (high_u ? 2 : 3) : high_u;
    u = 2 * u - high_u;  // exact
    v = 2 * v - high_v;
    std::unique_ptr<Node>& child = node->children[corner];
    if (!child) {
      child = std::make_unique<Node>(
          Refinement(node->mesh, data_->smooth_triangles).child(corner, true));
    }
    node = child.get();
  }
  const Real scale = mp::ldexp(Real(1), level), scale2 = scale * scale;
  const auto spline = [&](int du, int dv) {
    return test::evaluate(node->grid, Real(u), Real(v), du, dv);
  };
  const Point du = scale * spline(1, 0), dv = scale * spline(0, 1);
  const Point cross = {du.y * dv.z - du.z * dv.y, du.z * dv.x - du.x * dv.z,
                       du.x * dv.y - du.y * dv.x};
  const Real length = sqrt(cross.x * cross.x + cross.y * cross.y + cross.z * cross.z);
  Vector3 normal = Vector3::Constant(NAN);
  if (length > 0) normal = rounded((1 / length) * cross);
  return {{rounded(node->mesh.origin + spline(0, 0)), rounded(du), rounded(dv),
           rounded(scale2 * spline(2, 0)), rounded(scale2 * spline(1, 1)),
           rounded(scale2 * spline(0, 2)), normal}};
}

Vector3 DeepSubdivision::cornerPosition(int face, int corner) {
  LocalMesh mesh = data_->root(face).mesh;
  for (int level = 0; level < 2000; ++level) {
    if (mesh.regular()) {
      const Location at = cornerLocation(face, corner);
      return rounded(mesh.origin + test::evaluate(gridAround(mesh), at.u, at.v, 0, 0));
    }
    LocalMesh child = Refinement(mesh, data_->smooth_triangles).child(corner, true);
    const Vector3 step = rounded(child.origin - mesh.origin);
    mesh = std::move(child);
    // Steps shrink by a factor of 0.8 or less each.
    if (level > 8 && step.norm() <= 1e-22 * diagonal(data_->cage.positions)) break;
  }
  return rounded(mesh.origin);
}

}  // namespace limitsurf::test
