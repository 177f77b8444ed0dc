// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/patch/face_mesh.h"
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

/// One Catmull-Clark refinement of some faces of another level, and of those parts of the faces
/// around them that the neighbourhoods of their children need: the child at that corner of each
/// face at which it meets one of the refined faces.
///
/// The child of face f at its corner c has at its corners 0 to 3 the points of f's vertex c, of the
/// edge c, of f itself and of the edge c - 1: the orientation of Ptex sub-faces. The
/// surroundings are known for the children of the refined faces, and for the vertices of these,
/// alone. A point is made when it is first asked for.
class RefinedMesh final : public FaceMesh {
 public:
  RefinedMesh(FaceMesh& parent, const std::vector<int>& faces, const SubdivisionOptions& options,
              bool has_sharpness, RefinedPoints& points);

  int child(FaceCorner at) const { return child_of_corner_[parent_.cornerNumber(at)]; }
  FaceMesh& parent() const { return parent_; }
  /// The parent's vertex that this vertex is the new point of, or -1.
  int parentVertex(int vertex) const {
    return vertex < static_cast<int>(refined_vertices_.size()) ? refined_vertices_[vertex] : -1;
  }

 private:
  /// What a new vertex is the point of: the parent's edge as a side, or the face at a corner.
  struct NewVertex {
    unsigned corner : 31;
    bool of_face : 1;
  };

  void markVertices(const std::vector<int>& faces, bool with_neighbours);
  void makeChildren();
  void makeVertices();
  void setMidpoint(FaceCorner side);
  void setMiddle(int face);
  void makeTwins();
  void subdivideSharpness();
  void followCreases();
  int newVertex(NewVertex origin, StoredFan fan);
  /// The parent's corner at which a child stands.
  FaceCorner origin(int child) const { return parent_.cornerAt(origin_[child]); }

  /// Sets the sharpness around one of the parent's vertices, before and after a step.
  void getSubdivided(int parent_vertex, SharpnessAround& around) const;
  float childVertexSharpness(int parent_vertex, float sharpness) const;
  /// The sharpness of that half of the parent's edge that begins at the side's first vertex.
  float childSharpness(FaceCorner side) const;

  int makePoint(int vertex) override;
  int facePoint(int face);
  int edgePoint(FaceCorner side);
  int vertexPoint(int vertex);
  int smoothVertexPoint(int vertex, const VertexFan& parent_fan);
  int sharpVertexPoint(int vertex, const VertexFan& parent_fan);
  /// The parent's point at the far end of an edge of the vertex, or at one of the crease that it
  /// follows.
  int farEnd(int vertex, const VertexFan& parent_fan, int edge);
  /// The point of the parent's face at whose corner the child stands.
  int middle(int child) { return point(corner_vertices_own_[4 * child + 2]); }

  FaceMesh& parent_;
  const bool has_sharpness_;
  const OpenSubdiv::Sdc::Crease crease_;
  RefinedPoints& refined_points_;

  std::vector<int> refined_vertices_;  // of the parent; they are the first vertices here
  std::vector<int> origin_;            // per child: the parent's corner. The children around a
                                       // refined vertex have successive numbers
  std::vector<int> child_of_corner_;   // by the parent's corner; -1: none
  std::vector<int> corner_vertices_own_, twins_own_;
  std::vector<float> side_sharpness_own_;
  std::vector<NewVertex> new_vertices_;
  SharpnessAround around_;  // of the vertex whose point is being made
};

}  // namespace limitsurf
