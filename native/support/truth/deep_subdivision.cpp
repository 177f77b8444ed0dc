// SPDX-License-Identifier: Apache-2.0
#include "support/truth/deep_subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "support/truth/local_refinement.h"
#include "support/truth/spline_grid.h"
#include "support/truth/split_mesh.h"

namespace limitsurf::test {
namespace {

Real power(int exponent) { return boost::multiprecision::ldexp(Real(1), exponent); }

Real dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A refined face: either a patch, or an irregular face with those of its children that were asked
/// for so far.
struct Node {
  LocalMesh mesh;
  bool regular;
  SplineGrid grid;
  std::array<std::unique_ptr<Node>, 4> children;

  explicit Node(LocalMesh m) : mesh(std::move(m)), regular(mesh.regular()) {
    if (regular) grid = gridAround(mesh);
  }
};

/// Adds what the crease curve says of the derivatives at a corner of the first face: those along
/// the side to the `next` vertex, if this is infinitely sharp, or to the one before.
void addCurve(const LocalMesh& mesh, int level, int corner, bool next, Truth& truth) {
  const std::vector<int>& face = mesh.faces[0];
  const int v = face[corner], along = face[(corner + (next ? 1 : 3)) % 4];
  const LocalMesh::Vertex& vertex = mesh.vertices[v];
  if (!mesh.isOpen(v, along) || mesh.rule(v) == Rule::dart) return;
  const Point ahead = mesh.vertices[along].point;
  Point behind = Real(2) * vertex.point - ahead;  // where the curve ends
  if (mesh.rule(v) == Rule::crease) {
    int edge = along;
    for (const Spoke& spoke : mesh.sharp[v]) {
      if (spoke.to == along && spoke.again >= 0) edge = spoke.again;
    }
    const int other = mesh.sharp[v][0].to == edge ? 1 : 0;
    behind = mesh.vertices.at(mesh.sharp[v][other].to).point;
  }
  const bool in_u = (corner % 2 == 0) == next;
  const bool backwards = corner == 2 || corner == (next ? 3 : 1);
  const Point first = (power(level - 1) * (backwards ? -1 : 1)) * (ahead - behind);
  const Point second = power(2 * level) * (ahead + behind - Real(2) * vertex.point);
  truth.values[in_u ? kDu : kDv] = rounded(first);
  truth.values[in_u ? kDuu : kDvv] = rounded(second);
}

}  // namespace

struct DeepSubdivision::Data {
  Cage cage;
  SplitMesh split;
  std::vector<PtexFace> ptex;
  std::map<int, std::unique_ptr<Node>> roots;

  explicit Data(const Cage& c) : cage(c), split(c), ptex(ptexFaces(c)) {}

  LocalMesh neighbourhood(int base_face) const {
    std::vector<int> faces = {base_face};
    for (int vertex : split.faces[base_face]) {
      for (int face : split.faces_of_vertex[vertex]) {
        if (std::find(faces.begin(), faces.end(), face) == faces.end()) faces.push_back(face);
      }
    }
    LocalMesh mesh;
    std::map<int, int> local;
    const auto add = [&](int vertex) {
      const auto [found, is_new] = local.emplace(vertex, 0);
      if (is_new) {
        const SplitMesh::Vertex& global = split.vertices[vertex];
        const auto p = cage.positions.row(global.original);
        found->second = mesh.add({{p[0], p[1], p[2]}, global.faces, global.sharpness, global.loop});
      }
      return found->second;
    };
    for (int face : faces) {
      mesh.faces.emplace_back();
      for (int vertex : split.faces[face]) mesh.faces.back().push_back(add(vertex));
    }
    for (int vertex : split.faces[base_face]) {  // creases may lead out of these faces
      for (const Spoke& spoke : split.sharp[vertex]) {
        if (spoke.to >= 0) add(spoke.to);
      }
    }
    for (const auto& [global, vertex] : local) {
      for (const Spoke& spoke : split.sharp[global]) {
        const auto localOf = [&](int end) {
          const auto found = local.find(end);
          return found == local.end() ? -1 : found->second;
        };
        if (spoke.again >= 0 && localOf(spoke.again) < 0) continue;
        mesh.sharp[vertex].push_back({localOf(spoke.to), spoke.sharpness, localOf(spoke.again)});
      }
    }
    mesh.connect();
    return mesh;
  }

  Node& root(int face) {
    std::unique_ptr<Node>& node = roots[face];
    if (!node) {
      LocalMesh mesh = neighbourhood(ptex.at(face).base_face);
      if (!ptex[face].quad) mesh = refined(mesh, cage.options, ptex[face].corner, false);
      node = std::make_unique<Node>(std::move(mesh));
    }
    return *node;
  }
};

DeepSubdivision::DeepSubdivision(const Cage& cage) : data_(std::make_unique<Data>(cage)) {}
DeepSubdivision::~DeepSubdivision() = default;

/// The B-spline patch of a location, and where in the patch the location lies.
struct DeepSubdivision::Patch {
  const Node* node;
  double u, v;
  int level;

  Point derivative(int du, int dv) const {
    return power(level * (du + dv)) * test::evaluate(node->grid, Real(u), Real(v), du, dv);
  }
};

DeepSubdivision::Patch DeepSubdivision::patchAt(const Location& at) {
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
      child = std::make_unique<Node>(refined(node->mesh, data_->cage.options, corner, true));
    }
    node = child.get();
  }
  return {node, u, v, level};
}

Truth DeepSubdivision::evaluate(const Location& at) {
  const Patch patch = patchAt(at);
  const Point du = patch.derivative(1, 0), dv = patch.derivative(0, 1);
  const Point normal = cross(du, dv);
  const Real length = sqrt(dot(normal, normal));
  return {{rounded(patch.node->mesh.origin + patch.derivative(0, 0)), rounded(du), rounded(dv),
           rounded(patch.derivative(2, 0)), rounded(patch.derivative(1, 1)),
           rounded(patch.derivative(0, 2)),
           length > 0 ? rounded((1 / length) * normal) : Vector3::Constant(NAN)}};
}

TrueCurvature DeepSubdivision::curvature(const Location& at) {
  const Patch patch = patchAt(at);
  const Point du = patch.derivative(1, 0), dv = patch.derivative(0, 1);
  const Point across = cross(du, dv);
  const Real area = sqrt(dot(across, across));
  if (!(area > 0)) return {NAN, NAN, NAN, NAN, Vector3::Constant(NAN), 0};
  const Point n = (1 / area) * across;
  const Real E = dot(du, du), F = dot(du, dv), G = dot(dv, dv);
  const Real L = dot(patch.derivative(2, 0), n), M = dot(patch.derivative(1, 1), n),
             N = dot(patch.derivative(0, 2), n);
  const Real mean = (E * N - 2 * F * M + G * L) / (2 * area * area);
  const Real gaussian = (L * N - M * M) / (area * area);
  const Real square = mean * mean - gaussian;
  const Real radius = square > 0 ? Real(sqrt(square)) : Real(0);
  const Real k1 = mean + radius, k2 = mean - radius;
  // (x, y) with (L - k1 E) x + (M - k1 F) y = 0 and (M - k1 F) x + (N - k1 G) y = 0; the longer of
  // the two solutions.
  const Real l = L - k1 * E, m = M - k1 * F, g = N - k1 * G;
  const Point first = m * du - l * dv, second = g * du - m * dv;
  const Point direction = dot(first, first) > dot(second, second) ? first : second;
  const Real length = sqrt(dot(direction, direction));
  return {static_cast<double>(k1),
          static_cast<double>(k2),
          static_cast<double>(mean),
          static_cast<double>(gaussian),
          length > 0 ? rounded((1 / length) * direction) : Vector3::Constant(NAN),
          static_cast<double>(area)};
}

Truth DeepSubdivision::corner(int face, int corner) {
  Truth truth;
  truth.values.fill(Vector3::Constant(NAN));
  LocalMesh mesh = data_->root(face).mesh;
  int settled = -1;  // levels ago
  for (int level = 0; level < 2000; ++level) {
    if (mesh.regular()) return evaluate(cornerLocation(face, corner));
    if (mesh.settled() && ++settled == 0) {
      addCurve(mesh, level, corner, true, truth);
      addCurve(mesh, level, corner, false, truth);
      const int v = mesh.faces[0][corner];
      if (mesh.rule(v) == Rule::smooth && mesh.vertices[v].faces <= 3) {
        truth.values[kDu] = truth.values[kDv] = Vector3::Zero();
      }
    }
    LocalMesh child = refined(mesh, data_->cage.options, corner, true);
    const Vector3 step = rounded(child.origin - mesh.origin);
    mesh = std::move(child);
    // Steps shrink by a factor of 0.8 or less each.
    if (settled > 8 && step.norm() <= 1e-22 * diagonal(data_->cage.positions)) break;
  }
  truth.values[kPosition] = rounded(mesh.origin);
  return truth;
}

Vector3 DeepSubdivision::cornerPosition(int face, int corner) {
  return this->corner(face, corner)[kPosition];
}

}  // namespace limitsurf::test
