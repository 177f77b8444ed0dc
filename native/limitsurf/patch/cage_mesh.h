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
  int facesAt(VertexId vertex) const override {
    return isFan(vertex) ? static_cast<int>(fan(vertex).faces.size())
                         : level_.GetVertexFaces(static_cast<int>(vertex)).size();
  }
  bool interior(VertexId vertex) const override {
    return !isFan(vertex) && !level_.IsVertexBoundary(static_cast<int>(vertex));
  }
  FaceCorner faceAt(VertexId vertex, int i) const override {
    if (isFan(vertex)) {
      return {fan(vertex).faces[i].first, fan(vertex).faces[i].second};
    }
    const int v = static_cast<int>(vertex);
    return {level_.GetVertexFaces(v)[i], level_.GetVertexFaceLocalIndices(v)[i]};
  }
  bool pinned(VertexId vertex) const override {
    return isFan(vertex) ||
           (boundary_ == Boundary::corners && !interior(vertex) && facesAt(vertex) == 1);
  }
  int positionOf(FaceCorner at) const override { return positions_[corners_.number(at)]; }
  int point(VertexId vertex) override {
    return isFan(vertex) ? fan(vertex).vertex : static_cast<int>(vertex);
  }

 private:
  bool isFan(VertexId vertex) const { return vertex >= level_.GetNumVertices(); }
  const Topology::SplitFan& fan(VertexId vertex) const {
    return fans_[static_cast<std::size_t>(vertex - level_.GetNumVertices())];
  }

  const OpenSubdiv::Far::TopologyLevel& level_;
  const std::vector<Topology::SplitFan>& fans_;
  const CageCorners& corners_;
  Boundary boundary_;
  std::unordered_map<FaceId, int> fan_of_;  // corner -> fan, of split vertices
  std::vector<std::uint16_t> positions_;    // corner -> its face among its vertex's; 16 bits suffice
};

}  // namespace limitsurf
