// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/topology.h"

#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>

#include "limitsurf/mesh/messages.h"
#include "limitsurf/rules/subdivision_rules.h"
#include "limitsurf/work_aside.h"

namespace limitsurf {
namespace {

namespace Far = OpenSubdiv::Far;

/// Faces of up to this size are searched for repeated vertices without sorting, which takes longer.
constexpr std::size_t kFewVertices = 8;

/// Far is deaf while it makes a topology, some 0.2 seconds for each million corners.
constexpr std::size_t kCornersAside = 500'000;

/// A vertex that the face names twice, or -1.
int repeatedVertex(Span<int> vertices) {
  if (vertices.size() <= kFewVertices) {
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      if (std::find(vertices.begin(), vertices.begin() + i, vertices[i]) != vertices.begin() + i) {
        return vertices[i];
      }
    }
    return -1;
  }
  std::vector<int> sorted(vertices.begin(), vertices.end());
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  return twice == sorted.end() ? -1 : *twice;
}

/// Sharpness in the form that Far's factory reads.
struct Sharpness {
  std::vector<int> edges, vertices;
  std::vector<float> edge_values, vertex_values;

  explicit Sharpness(const ControlMesh& mesh) {
    const EdgeSharpness& edge = mesh.options().edge_sharpness;
    const VertexSharpness& vertex = mesh.options().vertex_sharpness;
    if (!edge.edges.empty()) {
      // Far searches an edge among those of its first vertex: take the end that has fewer.
      std::vector<int> faces_at(mesh.vertexCount(), 0);
      for (const int v : mesh.faceVertices()) {
        ++faces_at[v];
      }
      for (const auto& [a, b] : edge.edges) {
        const int u = static_cast<int>(a), v = static_cast<int>(b);
        const bool u_first = faces_at[u] <= faces_at[v];
        edges.push_back(u_first ? u : v);
        edges.push_back(u_first ? v : u);
      }
    }
    vertices.assign(vertex.vertices.begin(), vertex.vertices.end());
    const auto rounded = [](double sharpness) {
      return std::min(static_cast<float>(sharpness), kInfinitelySharp);
    };
    std::transform(edge.values.begin(), edge.values.end(), std::back_inserter(edge_values),
                   rounded);
    std::transform(vertex.values.begin(), vertex.values.end(), std::back_inserter(vertex_values),
                   rounded);
  }

  bool any() const {
    return std::any_of(edge_values.begin(), edge_values.end(), isSharp) ||
           std::any_of(vertex_values.begin(), vertex_values.end(), isSharp);
  }
};

/// What Far makes a topology of, with copies of all arrays.
struct FarInput {
  explicit FarInput(const ControlMesh& mesh)
      : vertex_count(mesh.vertexCount()),
        sizes(mesh.faceSizes()),
        vertices(mesh.faceVertices()),
        sharpness(mesh),
        options(sdcOptions(mesh.options())) {}

  std::unique_ptr<Far::TopologyRefiner> refiner() const {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = vertex_count;
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = vertices.data();
    descriptor.numCreases = static_cast<int>(sharpness.edge_values.size());
    descriptor.creaseVertexIndexPairs = sharpness.edges.data();
    descriptor.creaseWeights = sharpness.edge_values.data();
    descriptor.numCorners = static_cast<int>(sharpness.vertex_values.size());
    descriptor.cornerVertexIndices = sharpness.vertices.data();
    descriptor.cornerWeights = sharpness.vertex_values.data();
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, options)));
  }

  int vertex_count;
  std::vector<int> sizes, vertices;
  Sharpness sharpness;
  OpenSubdiv::Sdc::Options options;
};

}  // namespace

Topology::Topology(const ControlMesh& mesh, SeamSharpness seams)
    : mesh_(mesh), seams_(std::move(seams)) {
  for (const std::int64_t hole : mesh.options().holes) {
    refused_.emplace(static_cast<int>(hole), "it is a hole");
  }
  has_sharpness_ = Sharpness(mesh).any();
  if (std::optional<Adjacency> adjacency = Adjacency::ofManifold(mesh)) {
    adjacency_ = std::move(*adjacency);
    setSharpness();
    setLastingCorners();
    return;
  }
  is_manifold_ = false;
  readAdjacencyFromFar();
  readSharpnessFromFar();
  setLastingCorners();
  refuseRepeatedVertices();
  splitNonManifoldVertices();
}

const Far::TopologyLevel& Topology::level() const {
  if (!refiner_) {
    FarInput input(mesh_);
    if (InterruptionPoint::any() && mesh_.faceVertices().size() > kCornersAside) {
      refiner_ = workAside([input = std::move(input)] { return input.refiner(); });
    } else {
      refiner_ = input.refiner();
    }
    if (!refiner_) {
      throw MeshError("OpenSubdiv cannot represent the topology of the mesh");
    }
  }
  return refiner_->GetLevel(0);
}

void Topology::readAdjacencyFromFar() {
  const Far::TopologyLevel& far = level();
  adjacency_ = {};
  adjacency_.twins.assign(mesh_.faceVertices().size(), -1);
  InterruptionStride stride;
  for (int face = 0; face < mesh_.faceCount(); ++face) {
    stride.step();
    const auto edges = far.GetFaceEdges(face);
    for (int side = 0; side < edges.size(); ++side) {
      const auto faces = far.GetEdgeFaces(edges[side]);
      if (faces.size() == 2 && !far.IsEdgeNonManifold(edges[side])) {
        const auto sides = far.GetEdgeFaceLocalIndices(edges[side]);
        const int other = faces[0] == face && sides[0] == side ? 1 : 0;
        adjacency_.twins[mesh_.firstCorner(face) + side] =
            mesh_.firstCorner(faces[other]) + sides[other];
      }
    }
  }
  adjacency_.fans.resize(static_cast<std::size_t>(mesh_.vertexCount()));
  for (int vertex = 0; vertex < mesh_.vertexCount(); ++vertex) {
    stride.step();
    const auto faces = far.GetVertexFaces(vertex);
    Adjacency::Fan& fan = adjacency_.fans[vertex];
    fan.faces = faces.size();
    fan.closed = !far.IsVertexBoundary(vertex);
    if (!faces.empty()) {
      fan.first = mesh_.firstCorner(faces[0]) + far.GetVertexFaceLocalIndices(vertex)[0];
    }
  }
  adjacency_.findFaces(mesh_);
}

/// As Far does.
void Topology::setSharpness() {
  const Sharpness given(mesh_);
  const MeshOptions& options = mesh_.options();
  if (has_sharpness_) {
    side_sharpness_.assign(mesh_.faceVertices().size(), 0);
  }
  InterruptionStride stride;
  for (std::size_t i = 0; has_sharpness_ && i < given.edge_values.size(); ++i) {
    stride.step();
    // The first vertex is the one with fewer faces.
    const int side = adjacency_.side(mesh_, given.edges[2 * i], given.edges[2 * i + 1]);
    side_sharpness_[side] = given.edge_values[i];
    if (adjacency_.twins[side] >= 0) {
      side_sharpness_[adjacency_.twins[side]] = given.edge_values[i];
    }
  }
  if (given.vertices.empty() && options.boundary == Boundary::smooth) {
    return;
  }
  vertex_sharpness_.assign(adjacency_.fans.size(), 0);
  for (std::size_t i = 0; i < given.vertices.size(); ++i) {
    vertex_sharpness_[given.vertices[i]] = given.vertex_values[i];
  }
  for (std::size_t v = 0; v < adjacency_.fans.size(); ++v) {
    const Adjacency::Fan& fan = adjacency_.fans[v];
    if (options.boundary == Boundary::corners && fan.faces == 1 && !fan.closed) {
      vertex_sharpness_[v] = kInfinitelySharp;
    }
  }
}

void Topology::readSharpnessFromFar() {
  const Far::TopologyLevel& far = level();
  InterruptionStride stride;
  for (int vertex = 0; vertex < mesh_.vertexCount(); ++vertex) {
    stride.step();
    vertex_sharpness_.push_back(far.GetVertexSharpness(vertex));
  }
  for (int face = 0; has_sharpness_ && face < mesh_.faceCount(); ++face) {
    stride.step();
    for (const int edge : far.GetFaceEdges(face)) {
      side_sharpness_.push_back(far.GetEdgeSharpness(edge));
    }
  }
}

void Topology::setLastingCorners() {
  if (seams_.corners.empty()) {
    return;
  }
  has_sharpness_ = true;
  if (side_sharpness_.empty()) {
    side_sharpness_.assign(mesh_.faceVertices().size(), 0);
  }
  vertex_sharpness_.resize(static_cast<std::size_t>(mesh_.vertexCount()), 0);
  for (const auto& [vertex, corner] : seams_.corners) {
    vertex_sharpness_[vertex] = corner.sharpness();
  }
}

void Topology::refuseRepeatedVertices() {
  InterruptionStride stride;
  for (int face = 0; face < mesh_.faceCount(); ++face) {
    stride.step();
    const int twice = repeatedVertex(mesh_.faceVertices(face));
    if (twice >= 0) {
      refused_.emplace(face, text("it uses vertex ", twice, " twice"));
    }
  }
}

void Topology::splitNonManifoldVertices() {
  std::map<int, std::vector<std::pair<int, int>>> corners;  // vertex -> (face, corner) of each face
  for (int vertex = 0; vertex < mesh_.vertexCount(); ++vertex) {
    if (level().IsVertexNonManifold(vertex)) {
      corners[vertex];
    }
  }
  if (corners.empty()) {
    return;
  }
  InterruptionStride stride;
  for (int face = 0; face < mesh_.faceCount(); ++face) {
    stride.step();
    const Span<int> vertices = mesh_.faceVertices(face);
    for (int corner = 0; corner < static_cast<int>(vertices.size()); ++corner) {
      if (level().IsVertexNonManifold(vertices[corner])) {
        corners[vertices[corner]].emplace_back(face, corner);
      }
    }
  }
  for (const auto& [vertex, at] : corners) {
    stride.step();
    splitIntoFans(vertex, at);
  }
}

void Topology::splitIntoFans(int vertex, const std::vector<std::pair<int, int>>& corners) {
  // Manifold edge -> the corner from which it leaves, and the corner at which it arrives.
  std::map<int, int> leaving, arriving;
  std::vector<std::pair<int, int>> edges;  // of each corner: leaving, arriving
  for (const auto& [face, corner] : corners) {
    const auto of_face = level().GetFaceEdges(face);
    edges.emplace_back(of_face[corner], of_face[(corner + of_face.size() - 1) % of_face.size()]);
    const int i = static_cast<int>(edges.size()) - 1;
    if (!level().IsEdgeNonManifold(edges[i].first)) {
      leaving[edges[i].first] = i;
    }
    if (!level().IsEdgeNonManifold(edges[i].second)) {
      arriving[edges[i].second] = i;
    }
  }
  std::vector<bool> used(corners.size(), false);
  const auto follow = [&](int first) {
    SplitFan fan{vertex, false, {}};
    for (int i = first;;) {
      used[i] = true;
      fan.faces.push_back(corners[i]);
      const auto next = leaving.find(edges[i].second);
      if (next == leaving.end() || used[next->second]) {
        fan.closed = next != leaving.end();
        break;
      }
      i = next->second;
    }
    if (mesh_.options().scheme == Scheme::catmark) {
      setCreaseEnds(fan);
    }
    split_fans_.push_back(std::move(fan));
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!arriving.count(edges[i].first)) {
      follow(static_cast<int>(i));
    }
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!used[i]) {
      follow(static_cast<int>(i));
    }
  }
}

/// A vertex that is not manifold and not infinitely sharp lies on a crease of exactly two edges
/// that are not manifold.
void Topology::setCreaseEnds(SplitFan& fan) const {
  const Far::TopologyLevel& far = level();
  if (isInfinitelySharp(far.GetVertexSharpness(fan.vertex))) {
    return;
  }
  const auto edgeOf = [&](const std::pair<int, int>& at, int back) {
    const auto edges = far.GetFaceEdges(at.first);
    return edges[(at.second + edges.size() - back) % edges.size()];
  };
  const int first = edgeOf(fan.faces.front(), 0), last = edgeOf(fan.faces.back(), 1);
  if (!fan.closed && first != last) {
    return;
  }
  int count = 0;
  for (const int edge : far.GetVertexEdges(fan.vertex)) {
    if (far.IsEdgeNonManifold(edge) && count < 2) {
      const auto ends = far.GetEdgeVertices(edge);
      fan.crease_ends[count++] = ends[0] == fan.vertex ? ends[1] : ends[0];
      if (count == 2 && !fan.closed && edge == first) {
        std::swap(fan.crease_ends[0], fan.crease_ends[1]);
      }
    }
  }
}

}  // namespace limitsurf
