// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/cage_mesh.h"

namespace limitsurf {

CageMesh::CageMesh(const Topology& topology, const CageCorners& corners, Boundary boundary)
    : level_(topology.level()),
      fans_(topology.splitFans()),
      corners_(corners),
      boundary_(boundary),
      positions_(corners.count()) {
  const VertexId vertices = level_.GetNumVertices();
  for (VertexId v = 0; v < vertices + static_cast<VertexId>(fans_.size()); ++v) {
    for (int i = 0; i < facesAt(v); ++i) {
      const FaceId corner = corners_.number(faceAt(v, i));
      positions_[corner] = static_cast<std::uint16_t>(i);
      if (v >= vertices) {
        fan_of_[corner] = static_cast<int>(v - vertices);
      }
    }
  }
}

}  // namespace limitsurf
