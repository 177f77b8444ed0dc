// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Level 0: the control mesh itself. A vertex in which several fans meet counts as one vertex for
/// each fan; the numbers of these follow those of the mesh's own vertices.
class CageMesh final : public FaceMesh {
 public:
  CageMesh(const ControlMesh& mesh, const Topology& topology);

  int faceSize(int face) const override { return level_.GetFaceVertices(face).size(); }
  int vertex(FaceCorner at) const override {
    if (!fan_of_.empty()) {
      const auto fan = fan_of_.find(cornerNumber(at));
      if (fan != fan_of_.end()) {
        return level_.GetNumVertices() + fan->second;
      }
    }
    return level_.GetFaceVertices(at.face)[at.corner];
  }
  int cornerNumber(FaceCorner at) const override { return mesh_.firstCorner(at.face) + at.corner; }
  int cornerCount() const override { return static_cast<int>(mesh_.faceVertices().size()); }
  int vertexCount() const override {
    return level_.GetNumVertices() + static_cast<int>(fans_.size());
  }
  FaceCorner twin(FaceCorner side) const override {
    const int edge = level_.GetFaceEdges(side.face)[side.corner];
    const auto faces = level_.GetEdgeFaces(edge);
    if (faces.size() != 2 || (any_non_manifold_ && level_.IsEdgeNonManifold(edge))) {
      return {};
    }
    const auto sides = level_.GetEdgeFaceLocalIndices(edge);
    const int other = faces[0] == side.face && sides[0] == side.corner ? 1 : 0;
    return {faces[other], sides[other]};
  }
  float sharpness(FaceCorner side) const override {
    return level_.GetEdgeSharpness(level_.GetFaceEdges(side.face)[side.corner]);
  }

  /// The same, but faster if no edge is sharp.
  // NOLINTNEXTLINE(bugprone-derived-method-shadowing-base-method)
  FaceCorner across(FaceCorner side) const {
    return has_sharpness_ ? FaceMesh::across(side) : twin(side);
  }

  VertexFan fan(int vertex) const override;
  bool onlyQuadsAround(int vertex) const override { return (marks_[vertex] & kQuads) != 0; }
  std::vector<float> edgesOfOtherFans(int vertex) const override;
  int point(int vertex) override { return isSplit(vertex) ? splitFan(vertex).vertex : vertex; }

  /// Whether the surface around the vertex is a B-spline, provided that all its faces are quads.
  bool regularVertex(int vertex) const { return (marks_[vertex] & kRegular) != 0; }
  /// Whether the face's surface is one B-spline patch, smooth inside.
  bool regularFace(int face) const;
  /// The corners of a regular face that have faces all around.
  std::array<bool, 4> diagonals(int face) const;

 private:
  enum Mark : std::uint8_t { kRegular = 1, kQuads = 2 };

  bool isSplit(int vertex) const { return vertex >= level_.GetNumVertices(); }
  const Topology::SplitFan& splitFan(int vertex) const {
    return fans_[static_cast<std::size_t>(vertex - level_.GetNumVertices())];
  }
  void mark(int vertex);
  bool isRegular(int vertex, const VertexFan& around) const;

  const ControlMesh& mesh_;
  const OpenSubdiv::Far::TopologyLevel& level_;
  const std::vector<Topology::SplitFan>& fans_;
  const bool has_sharpness_, any_non_manifold_;
  std::unordered_map<int, int> fan_of_;  // corner -> fan, of split vertices
  std::vector<std::uint8_t> marks_;      // per vertex
};

}  // namespace limitsurf
