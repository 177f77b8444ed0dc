// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/face_varying_mesh.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "limitsurf/interruption_point.h"
#include "limitsurf/mesh/messages.h"
#include "limitsurf/mesh/value_vertices.h"
#include "limitsurf/rules/decaying_sharpness.h"
#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {
namespace {

namespace Far = OpenSubdiv::Far;

void checkIndices(const ControlMesh& mesh, const std::vector<std::int64_t>& indices,
                  std::int64_t value_count) {
  if (indices.size() != mesh.faceVertices().size()) {
    refuse("indices has ", indices.size(), " entries; the mesh has ", mesh.faceVertices().size(),
           " face corners");
  }
  for (int face = 0; face < mesh.faceCount(); ++face) {
    for (int i = 0; i < mesh.faceSize(face); ++i) {
      const std::int64_t index = indices[mesh.firstCorner(face) + i];
      if (index < 0 || index >= value_count) {
        refuse("corner ", i, " of face ", face, " has value index ", index, "; there are ",
               value_count, " values");
      }
    }
  }
}

class Builder {
 public:
  Builder(const ControlMesh& mesh, const Topology& topology,
          const std::vector<std::int64_t>& indices, Interpolation interpolation)
      : mesh_(mesh),
        level_(topology.level()),
        interpolation_(interpolation),
        vertices_(mesh, topology, indices),
        around_(vertices_.values.size()) {
    for (std::size_t i = 0; i < around_.size(); ++i) {
      around_[i].faces = vertices_.faces[i];
    }
    options_.triangles = mesh.options().triangles;
    options_.creasing = mesh.options().creasing;
    options_.scheme =
        interpolation == Interpolation::all ? Scheme::bilinear : mesh.options().scheme;
    for (const auto& [face, reason] : topology.refused()) {
      options_.holes.push_back(face);
    }
    if (options_.scheme == Scheme::catmark) {
      addEdges();
      InterruptionStride stride;
      for (int vertex = 0; vertex < mesh.vertexCount(); ++vertex) {
        stride.step();
        addVertex(vertex);
      }
    }
  }

  FaceVaryingMesh build() {
    const std::vector<int> sizes = mesh_.faceSizes();
    return {
        ControlMesh(Points::Zero(static_cast<Eigen::Index>(vertices_.values.size()), 3),
                    {sizes.begin(), sizes.end()},
                    {vertices_.at_corner.begin(), vertices_.at_corner.end()}, std::move(options_)),
        std::move(vertices_.values), std::move(seams_)};
  }

 private:
  /// The faces and edges around one value at a vertex.
  struct Surroundings {
    int faces = 0;
    int inner_edges = 0;     ///< between two of its faces
    int infinite_edges = 0;  ///< how many of these are infinitely sharp
    int semi_sharp_edges = 0;

    /// Whether the value lies in several fans of faces. All of them are open: a closed fan would be
    /// the only one at the vertex.
    bool disjoint() const { return faces - inner_edges > 1; }
  };

  /// The new vertices at the ends of an edge in one of its faces, in the order of Far's edge.
  std::pair<int, int> endsIn(int edge, int i) const {
    const int face = level_.GetEdgeFaces(edge)[i];
    const int side = level_.GetEdgeFaceLocalIndices(edge)[i];
    const int a = mesh_.firstCorner(face) + side;
    const int b = mesh_.firstCorner(face) + (side + 1) % mesh_.faceSize(face);
    const bool along = mesh_.faceVertices()[a] == level_.GetEdgeVertices(edge)[0];
    return along ? std::pair(vertices_.at_corner[a], vertices_.at_corner[b])
                 : std::pair(vertices_.at_corner[b], vertices_.at_corner[a]);
  }

  bool isSeam(int edge) const {
    const int faces = level_.GetEdgeFaces(edge).size();
    for (int i = 1; i < faces; ++i) {
      if (endsIn(edge, i) != endsIn(edge, 0)) {
        return true;
      }
    }
    return false;
  }

  void addEdges() {
    at_seam_.assign(mesh_.vertexCount(), false);
    InterruptionStride stride;
    for (int edge = 0; edge < level_.GetNumEdges(); ++edge) {
      stride.step();
      if (level_.GetEdgeFaces(edge).size() < 2) {
        continue;
      }
      if (isSeam(edge)) {
        addSeam(edge);
        continue;
      }
      const float sharpness = level_.GetEdgeSharpness(edge);
      const auto ends = endsIn(edge, 0);
      for (const int end : {ends.first, ends.second}) {
        Surroundings& around = around_[end];
        ++around.inner_edges;
        around.infinite_edges += isInfinitelySharp(sharpness);
        around.semi_sharp_edges += isSemiSharp(sharpness);
      }
      if (isSharp(sharpness)) {
        addEdge(ends, sharpness);
      }
    }
  }

  void addSeam(int edge) {
    const auto vertices = level_.GetEdgeVertices(edge);
    at_seam_[vertices[0]] = at_seam_[vertices[1]] = true;
    if (level_.IsEdgeNonManifold(edge)) {
      // Two of three faces may have the same values, but must not be joined.
      for (int i = 0; i < level_.GetEdgeFaces(edge).size(); ++i) {
        addEdge(endsIn(edge, i), kInfinitelySharp);
      }
    }
  }

  void addEdge(std::pair<int, int> ends, double sharpness) {
    options_.edge_sharpness.edges.emplace_back(ends);
    options_.edge_sharpness.values.push_back(sharpness);
  }

  void setSharpness(int derived, double sharpness) {
    if (sharpness > 0) {
      options_.vertex_sharpness.vertices.push_back(derived);
      options_.vertex_sharpness.values.push_back(sharpness);
    }
  }

  void addVertex(int vertex) {
    const int begin = vertices_.first[vertex], end = vertices_.first[vertex + 1];
    if (begin == end) {
      return;
    }
    const double own = level_.GetVertexSharpness(vertex);  // infinite at corners that are pinned
    if (isDivided(vertex)) {
      setAveragedEdges(vertex);
    }
    const bool all_pinned = allPinned(vertex);
    for (int derived = begin; derived < end; ++derived) {
      const bool corner = around_[derived].faces == 1 && interpolation_ != Interpolation::none;
      if (all_pinned || corner) {
        setSharpness(derived, kInfinitelySharp);
      } else if (own == 0 && dependsOnOther(vertex, derived)) {
        setCornerAcross(vertex, begin + end - 1 - derived, derived);
      } else {
        setSharpness(derived, own);
      }
    }
  }

  /// Whether several values or a seam divide the faces around the vertex.
  bool isDivided(int vertex) const {
    return at_seam_[vertex] || vertices_.first[vertex + 1] - vertices_.first[vertex] > 1;
  }

  bool allPinned(int vertex) const {
    const int begin = vertices_.first[vertex], end = vertices_.first[vertex + 1];
    const bool on_boundary = level_.IsVertexBoundary(vertex);
    if (interpolation_ == Interpolation::boundaries) {
      return on_boundary || isDivided(vertex);
    }
    if (isDivided(vertex) && level_.IsVertexNonManifold(vertex)) {
      return true;
    }
    if (!at_seam_[vertex] || !sharpensAcross()) {
      return false;
    }
    const bool plus2 = interpolation_ == Interpolation::corners_plus2;
    if (end - begin == 1) {
      return plus2 && !on_boundary;
    }
    if (end - begin > 2) {
      return true;
    }
    return std::any_of(&around_[begin], &around_[begin] + 2, [&](const Surroundings& around) {
      return around.disjoint() || around.infinite_edges > 0 || (plus2 && around.faces == 1);
    });
  }

  bool sharpensAcross() const {
    return interpolation_ == Interpolation::corners_plus1 ||
           interpolation_ == Interpolation::corners_plus2;
  }

  /// Whether a value is one of two at a vertex and, though smooth itself, remains a corner for as
  /// long as the other one does.
  bool dependsOnOther(int vertex, int derived) const {
    const int begin = vertices_.first[vertex], end = vertices_.first[vertex + 1];
    return sharpensAcross() && at_seam_[vertex] && end - begin == 2 &&
           around_[derived].semi_sharp_edges == 0 &&
           around_[begin + end - 1 - derived].semi_sharp_edges > 0;
  }

  /// The sharpness of the vertex's edges. The first `count` of them lie between faces with the
  /// value.
  std::vector<float> sharpnessAround(int vertex, int derived, int& count) const {
    std::vector<float> inner, others;
    for (const int edge : level_.GetVertexEdges(vertex)) {
      const auto ends = endsIn(edge, 0);
      const bool is_inner = level_.GetEdgeFaces(edge).size() > 1 && !isSeam(edge) &&
                            (ends.first == derived || ends.second == derived);
      (is_inner ? inner : others).push_back(level_.GetEdgeSharpness(edge));
    }
    count = static_cast<int>(inner.size());
    inner.insert(inner.end(), others.begin(), others.end());
    return inner;
  }

  /// A value stays a corner for as long as the edges of the other one are sharp.
  void setCornerAcross(int vertex, int other, int derived) {
    int count;
    DecayingSharpness around(mesh_.options(), sharpnessAround(vertex, other, count));
    const auto sharp = [&](const std::vector<float>& edges) {
      return std::any_of(edges.begin(), edges.begin() + count, isSharp);
    };
    int steps = 1;
    for (; sharp(around.nextEdges()); ++steps) {
      around.advance();
    }
    // OpenSubdiv does not blend the two rules while the seam itself is still sharp.
    const float share = around.nextSemiSharp() ? 1 : around.weight(count);
    const float lasting = static_cast<float>(steps - 1) + share;
    float left = lasting;
    for (int i = 1; i < steps; ++i) {
      left -= 1;
    }
    if (left == share) {
      setSharpness(derived, lasting);
    } else {  // the sum is rounded
      seams_.corners[derived] = {steps, share};
    }
  }

  /// Chaikin's rule averages sharpness over all edges at a vertex, including seams. The edges of a
  /// value decay in the same way without the others where all are equally sharp, say.
  void setAveragedEdges(int vertex) {
    if (mesh_.options().creasing == Creasing::uniform) {
      return;
    }
    for (int derived = vertices_.first[vertex]; derived < vertices_.first[vertex + 1]; ++derived) {
      if (around_[derived].semi_sharp_edges == 0) {
        continue;
      }
      int count;
      const std::vector<float> edges = sharpnessAround(vertex, derived, count);
      DecayingSharpness whole(mesh_.options(), edges);
      DecayingSharpness part(mesh_.options(), {edges.begin(), edges.begin() + count});
      const auto alike = [&] {
        return std::equal(part.edges().begin(), part.edges().end(), whole.edges().begin());
      };
      for (; alike() && part.semiSharp(); part.advance()) {
        whole.advance();
      }
      if (!alike()) {
        std::copy_if(edges.begin() + count, edges.end(),
                     std::back_inserter(seams_.averaged_edges[derived]), isSemiSharp);
      }
    }
  }

  const ControlMesh& mesh_;
  const Far::TopologyLevel& level_;
  const Interpolation interpolation_;
  MeshOptions options_;
  ValueVertices vertices_;
  std::vector<Surroundings> around_;  // per new vertex
  SeamSharpness seams_;
  std::vector<bool> at_seam_;  // per vertex of the mesh: whether it is on a seam
};

}  // namespace

FaceVaryingMesh faceVaryingMesh(const ControlMesh& mesh, const Topology& topology,
                                const std::vector<std::int64_t>& indices, std::int64_t value_count,
                                Interpolation interpolation) {
  checkIndices(mesh, indices, value_count);
  return Builder(mesh, topology, indices, interpolation).build();
}

}  // namespace limitsurf
