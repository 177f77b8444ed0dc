// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <unordered_map>
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

  int faceSize(int) const override { return 4; }
  int vertex(FaceCorner at) const override { return corner_vertex_[cornerNumber(at)]; }
  int cornerNumber(FaceCorner at) const override { return 4 * at.face + at.corner; }
  int cornerCount() const override { return static_cast<int>(corner_vertex_.size()); }
  int vertexCount() const override { return static_cast<int>(point_.size()); }
  FaceCorner twin(FaceCorner side) const override {
    const int twin = twin_[cornerNumber(side)];
    return twin < 0 ? FaceCorner{} : FaceCorner{twin / 4, twin % 4};
  }
  float sharpness(FaceCorner side) const override;
  VertexFan fan(int vertex) const override;
  bool onlyQuadsAround(int) const override { return true; }
  std::vector<float> edgesOfOtherFans(int vertex) const override;
  int point(int vertex) override;

 private:
  enum Origin { kEdge, kFace };
  struct NewVertex {
    Origin origin;
    FaceCorner at;  ///< the parent's edge as a side; the face's first corner
  };

  void markVertices(const std::vector<int>& faces, bool with_neighbours);
  void makeChildren();
  void makeVertices();
  void makeTwins();
  void subdivideSharpness();
  int newVertex(Origin origin, FaceCorner at);

  /// The sharpness around one of the parent's vertices, before and after a step.
  SharpnessAround subdivided(int parent_vertex) const;
  /// The sharpness of that half of the parent's edge that begins at the side's first vertex.
  float childSharpness(FaceCorner side) const;

  /// A vertex of the parent, and its corners in the faces around it.
  struct VertexNeighbours {
    int vertex;
    VertexFan fan;
    std::vector<FaceCorner> corners;
  };
  VertexNeighbours neighbours(int parent_vertex, const VertexFan& fan) const;
  /// The parent's point at the far end of an edge of the vertex.
  int farEnd(const VertexNeighbours& around, int edge);

  int facePoint(int face);
  int edgePoint(FaceCorner side);
  int vertexPoint(int parent_vertex);
  int smoothVertexPoint(const VertexNeighbours& around);
  int sharpVertexPoint(const VertexNeighbours& around, const SharpnessAround& sharpness);

  FaceMesh& parent_;
  const bool has_sharpness_;
  const OpenSubdiv::Sdc::Crease crease_;
  RefinedPoints& points_;

  std::vector<int> refined_vertices_;  // of the parent; they are the first vertices here
  std::vector<VertexFan> fans_;        // of these; the children around one have successive numbers
  std::vector<FaceCorner> origin_;     // per child: the parent's corner
  std::vector<int> child_of_corner_;   // by the parent's corner; -1: none
  std::vector<int> corner_vertex_, twin_;  // per corner
  std::vector<float> side_sharpness_;      // per corner; none if nothing is sharp
  std::vector<NewVertex> new_vertices_;
  std::unordered_map<int, int> face_vertex_;  // parent's face -> vertex
  std::map<int, std::vector<float>> other_fans_edges_;
  std::vector<int> point_;  // per vertex; -1: not made yet
};

}  // namespace limitsurf
