// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/corner_numbering.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Level 0: the control mesh itself.
class CageMesh final : public FaceMesh {
 public:
  CageMesh(const Topology& topology, const CageCorners& corners)
      : level_(topology.level()), corners_(corners), positions_(corners.count()) {
    for (int v = 0; v < level_.GetNumVertices(); ++v) {
      for (int i = 0; i < facesAt(v); ++i) {
        positions_[corners_.number(faceAt(v, i))] = static_cast<std::uint16_t>(i);
      }
    }
  }

  int faceSize(FaceId face) const override {
    return level_.GetFaceVertices(static_cast<int>(face)).size();
  }
  VertexId vertex(FaceCorner at) const override {
    return level_.GetFaceVertices(static_cast<int>(at.face))[at.corner];
  }
  int facesAt(VertexId vertex) const override {
    return level_.GetVertexFaces(static_cast<int>(vertex)).size();
  }
  bool interior(VertexId vertex) const override {
    return !level_.IsVertexBoundary(static_cast<int>(vertex));
  }
  FaceCorner faceAt(VertexId vertex, int i) const override {
    const int v = static_cast<int>(vertex);
    return {level_.GetVertexFaces(v)[i], level_.GetVertexFaceLocalIndices(v)[i]};
  }
  int positionOf(FaceCorner at) const override { return positions_[corners_.number(at)]; }
  int point(VertexId vertex) override { return static_cast<int>(vertex); }

 private:
  const OpenSubdiv::Far::TopologyLevel& level_;
  const CageCorners& corners_;
  std::vector<std::uint16_t> positions_;  // valences fit in 16 bits
};

}  // namespace limitsurf
