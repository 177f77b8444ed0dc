// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/patch/cage_mesh.h"

#include "limitsurf/parallel.h"

namespace limitsurf {

CageMesh::CageMesh(const Topology& topology, const CageCorners& corners, Boundary boundary)
    : level_(topology.level()),
      fans_(topology.splitFans()),
      corners_(corners),
      boundary_(boundary),
      marks_(level_.GetNumVertices() + fans_.size()) {
  parallelFor(marks_.size(), 16384, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      mark(static_cast<VertexId>(v));
    }
  });
  for (VertexId v = 0; v < static_cast<VertexId>(marks_.size()); ++v) {
    if (!isSplit(v) && (marks_[v] & kRegular)) {
      continue;
    }
    for (int i = 0; i < fan(v).faces; ++i) {
      const FaceId corner = corners_.number(faceAt(v, i));
      positions_[corner] = i;
      if (isSplit(v)) {
        fan_of_[corner] = static_cast<int>(v - level_.GetNumVertices());
      }
    }
  }
}

void CageMesh::mark(VertexId vertex) {
  const VertexFan around = fan(vertex);
  std::uint8_t marks = kQuads;
  for (int i = 0; i < around.faces; ++i) {
    if (faceSize(faceAt(vertex, i).face) != 4) {
      marks = 0;
      break;
    }
  }
  marks_[vertex] = static_cast<std::uint8_t>(marks | (around.regular() ? kRegular : 0));
}

VertexFan CageMesh::fan(VertexId vertex) const {
  if (isSplit(vertex)) {
    return {static_cast<int>(splitFan(vertex).faces.size()), false, true};
  }
  const int v = static_cast<int>(vertex);
  const int faces = level_.GetVertexFaces(v).size();
  const bool interior = !level_.IsVertexBoundary(v);
  return {faces, interior, !interior && faces == 1 && boundary_ == Boundary::corners};
}

bool CageMesh::regularFace(FaceId face) const {
  if (faceSize(face) != 4) {
    return false;
  }
  for (int corner = 0; corner < 4; ++corner) {
    if (marks_[vertex({face, corner})] != (kRegular | kQuads)) {
      return false;
    }
  }
  return true;
}

}  // namespace limitsurf
