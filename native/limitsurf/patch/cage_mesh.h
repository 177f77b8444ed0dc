// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/corner_numbering.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Level 0: the control mesh itself. A vertex in which several fans meet counts as one vertex for
/// each fan; the ids of these follow those of the mesh's own vertices.
class CageMesh final : public FaceMesh {
 public:
  CageMesh(const Topology& topology, const CageCorners& corners, Boundary boundary);

  int faceSize(FaceId face) const override {
    return level_.GetFaceVertices(static_cast<int>(face)).size();
  }
  VertexId vertex(FaceCorner at) const override {
    if (!fan_of_.empty()) {
      const auto fan = fan_of_.find(corners_.number(at));
      if (fan != fan_of_.end()) {
        return level_.GetNumVertices() + fan->second;
      }
    }
    return level_.GetFaceVertices(static_cast<int>(at.face))[at.corner];
  }
  FaceCorner twin(FaceCorner side) const override {
    const int edge = level_.GetFaceEdges(static_cast<int>(side.face))[side.corner];
    const auto faces = level_.GetEdgeFaces(edge);
    if (faces.size() < 2) {
      return {};
    }
    const auto sides = level_.GetEdgeFaceLocalIndices(edge);
    const int other = faces[0] == side.face && sides[0] == side.corner ? 1 : 0;
    return {faces[other], sides[other]};
  }

  VertexFan fan(VertexId vertex) const override;
  bool onlyQuadsAround(VertexId vertex) const override { return (marks_[vertex] & kQuads) != 0; }
  FaceCorner faceAt(VertexId vertex, int i) const override {
    if (isSplit(vertex)) {
      const auto& [face, corner] = splitFan(vertex).faces[i];
      return {face, corner};
    }
    const int v = static_cast<int>(vertex);
    return {level_.GetVertexFaces(v)[i], level_.GetVertexFaceLocalIndices(v)[i]};
  }
  int positionOf(FaceCorner at) const override { return positions_.at(corners_.number(at)); }
  int point(VertexId vertex) override {
    return isSplit(vertex) ? splitFan(vertex).vertex : static_cast<int>(vertex);
  }

  /// Whether the face's surface is one B-spline patch.
  bool regularFace(FaceId face) const;

 private:
  enum Mark : std::uint8_t { kRegular = 1, kQuads = 2 };

  bool isSplit(VertexId vertex) const { return vertex >= level_.GetNumVertices(); }
  const Topology::SplitFan& splitFan(VertexId vertex) const {
    return fans_[static_cast<std::size_t>(vertex - level_.GetNumVertices())];
  }
  void mark(VertexId vertex);

  const OpenSubdiv::Far::TopologyLevel& level_;
  const std::vector<Topology::SplitFan>& fans_;
  const CageCorners& corners_;
  Boundary boundary_;
  std::unordered_map<FaceId, int> fan_of_;     // corner -> fan, of split vertices
  std::unordered_map<FaceId, int> positions_;  // corner -> position, of irregular vertices
  std::vector<std::uint8_t> marks_;            // per vertex
};

}  // namespace limitsurf
