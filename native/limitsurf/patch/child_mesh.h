// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "limitsurf/patch/corner_numbering.h"
#include "limitsurf/patch/face_mesh.h"
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

/// One Catmull-Clark refinement of another level, of which only the points asked for come to be.
///
/// Face (f, c), the child of f at its corner c, has at its corners 0 to 3 the points of f's vertex
/// c, of the edge c, of f itself and of the edge c - 1: the orientation of Ptex sub-faces.
class ChildMesh final : public FaceMesh {
 public:
  /// `corners` numbers the parent's corners; the numbers are the children's ids.
  ChildMesh(FaceMesh& parent, const CornerNumbering& corners, RefinedPoints& points)
      : parent_(parent), corners_(corners), points_(points) {}

  FaceId child(FaceCorner at) const { return corners_.number(at); }
  FaceMesh& parent() const { return parent_; }

  /// The parent's vertex that this vertex is the new point of, or -1.
  VertexId parentVertex(VertexId vertex) const { return vertex % 3 == kOfVertex ? vertex / 3 : -1; }

  int faceSize(FaceId) const override { return 4; }
  VertexId vertex(FaceCorner at) const override;
  FaceCorner twin(FaceCorner side) const override;
  VertexFan fan(VertexId vertex) const override;
  bool onlyQuadsAround(VertexId) const override { return true; }
  FaceCorner faceAt(VertexId vertex, int i) const override;
  int positionOf(FaceCorner at) const override;
  int point(VertexId vertex) override;

 private:
  // A vertex's id is three times the id of what it is the new point of, plus one of these.
  enum Origin { kOfVertex = 0, kOfEdge = 1, kOfFace = 2 };

  VertexId ofEdge(FaceCorner side) const;
  int makePoint(VertexId vertex);
  int makeVertexPoint(VertexId parent_vertex);

  FaceMesh& parent_;
  const CornerNumbering& corners_;
  RefinedPoints& points_;
  std::unordered_map<VertexId, int> made_;
};

}  // namespace limitsurf
