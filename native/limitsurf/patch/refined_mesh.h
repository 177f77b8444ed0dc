// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "limitsurf/patch/face_mesh.h"
#include "limitsurf/patch/refined_points.h"

namespace limitsurf {

/// One Catmull-Clark refinement of some faces of another level, with as much of the faces around
/// them as their children's neighbourhoods take: the corner children at every vertex of the faces.
///
/// The child of face f at its corner c has at its corners 0 to 3 the points of f's vertex c, of the
/// edge c, of f itself and of the edge c - 1: the orientation of Ptex sub-faces. Only children of
/// the refined faces, and vertices of these, may be asked about their surroundings. Points come to
/// be when they are asked for.
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
  std::vector<float> strangeEdges(int vertex) const override;
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

  /// The sharpness around one of the parent's vertices and what a step makes of it.
  SharpnessAround subdivided(int parent_vertex) const;
  /// Of the half of the parent's edge that begins at the side's first vertex.
  float childSharpness(FaceCorner side) const;

  int facePoint(int face);
  int edgePoint(FaceCorner side);
  int vertexPoint(int parent_vertex);

  FaceMesh& parent_;
  const bool has_sharpness_;
  const OpenSubdiv::Sdc::Crease crease_;
  RefinedPoints& points_;

  std::vector<int> refined_vertices_;      // of the parent; their new points come first
  std::vector<VertexFan> fans_;            // of each of those; their children follow each other
  std::vector<FaceCorner> origin_;         // per child
  std::vector<int> child_of_corner_;       // by the parent's corner; -1: none
  std::vector<int> corner_vertex_, twin_;  // per corner
  std::vector<float> side_sharpness_;      // per corner; none if nothing is sharp
  std::vector<NewVertex> new_vertices_;
  std::unordered_map<int, int> face_vertex_;  // parent's face -> vertex
  std::map<int, std::vector<float>> strange_edges_;
  std::vector<int> point_;  // per vertex; -1: not made yet
};

}  // namespace limitsurf
