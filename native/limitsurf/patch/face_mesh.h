// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "limitsurf/mesh/adjacency.h"
#include "limitsurf/rules/seam_sharpness.h"
#include "limitsurf/rules/subdivision_rules.h"

namespace limitsurf {

/// A corner of a face. Used as a side of the face, it means the edge from this corner to the next.
struct FaceCorner {
  int face = -1;
  int corner = 0;

  bool exists() const { return face >= 0; }
  friend bool operator==(FaceCorner a, FaceCorner b) {
    return a.face == b.face && a.corner == b.corner;
  }
};

/// The faces around a vertex, as far as manifold edges link them.
struct VertexFan {
  FaceCorner first;  ///< FaceMesh::turned() leads to the others; on a boundary it is the first one
  int faces;
  bool closed;  ///< faces all around
  float sharpness;

  int edges() const { return closed ? faces : faces + 1; }
};

using CreaseEnds = std::array<int, 2>;

/// One level of refinement: its topology and its sharpness, in arrays that CageMesh and RefinedMesh
/// fill.
class FaceMesh {
 public:
  virtual ~FaceMesh() = default;
  FaceMesh(const FaceMesh&) = delete;
  FaceMesh& operator=(const FaceMesh&) = delete;

  int faceSize(int face) const {
    return first_corners_ ? first_corners_[face + 1] - first_corners_[face] : 4;
  }
  /// Consecutive numbers for all corners of all faces.
  int cornerNumber(FaceCorner at) const {
    return (first_corners_ ? first_corners_[at.face] : 4 * at.face) + at.corner;
  }
  FaceCorner cornerAt(int number) const {
    if (!first_corners_) {
      return {number / 4, number % 4};
    }
    const int face = face_of_corner_[number];
    return {face, number - first_corners_[face]};
  }
  int cornerCount() const { return corner_count_; }
  int vertexCount() const { return vertex_count_; }
  int vertex(FaceCorner at) const { return corner_vertices_[cornerNumber(at)]; }

  /// The same edge as a side of the face beyond it. There is none on a boundary and at an edge that
  /// is not manifold.
  FaceCorner twin(FaceCorner side) const {
    const int twin = twins_[cornerNumber(side)];
    return twin < 0 ? FaceCorner{} : cornerAt(twin);
  }
  /// The sharpness of the edge; infinite where the side has no twin.
  float sharpness(FaceCorner side) const {
    const int number = cornerNumber(side);
    return twins_[number] < 0 ? kInfinitelySharp : side_sharpness_ ? side_sharpness_[number] : 0;
  }

  bool onlyQuads() const { return !first_corners_; }
  // The same by the numbers of corners, for what is looked at most.
  int vertexAt(int corner) const { return corner_vertices_[corner]; }
  /// The number of across(), or -1.
  int acrossAt(int corner) const {
    return side_sharpness_ && isInfinitelySharp(side_sharpness_[corner]) ? -1 : twins_[corner];
  }
  /// The corner so many steps further around a face that is a quad. `kOnlyQuads`: all faces of the
  /// mesh are.
  template <bool kOnlyQuads>
  int aroundQuad(int corner, int steps) const {
    const int first = kOnlyQuads ? corner & ~3 : first_corners_[face_of_corner_[corner]];
    return first + ((corner - first + steps) & 3);
  }

  VertexFan fan(int vertex) const {
    if (vertex >= own_points_) {
      const int i = vertex - own_points_;
      const StoredFan& stored = fans_[i];
      return {cornerAt(stored.first), stored.faces, stored.closed,
              i < static_cast<int>(fan_sharpness_.size()) ? fan_sharpness_[i] : 0};
    }
    const Adjacency::Fan& fan = cage_fans_[vertex];
    return {fan.first < 0 ? FaceCorner{} : cornerAt(fan.first), fan.faces, fan.closed,
            cage_sharpness_ ? cage_sharpness_[vertex] : 0};
  }
  /// The sharpness of those sharp edges at the vertex that belong to none of its fan's faces, but
  /// of at most three that are infinitely sharp; null if there are none.
  const std::vector<float>* edgesOfOtherFans(int vertex) const {
    if (other_fans_edges_.empty()) {
      return nullptr;
    }
    const auto known = other_fans_edges_.find(vertex);
    return known == other_fans_edges_.end() ? nullptr : &known->second;
  }

  /// The points at the far ends of the crease that a vertex follows, where the crease is not its
  /// fan's boundary on both sides (Topology::SplitFan); null at all other vertices. The crease's
  /// edges are among edgesOfOtherFans() of a closed fan; of an open fan, the last edge stands for
  /// the second one.
  bool hasCreaseEnds() const { return !crease_ends_.empty(); }
  const CreaseEnds* creaseEnds(int vertex) const {
    if (!hasCreaseEnds()) {
      return nullptr;
    }
    const auto known = crease_ends_.find(vertex);
    return known == crease_ends_.end() ? nullptr : &known->second;
  }

  /// One of SeamSharpness::corners, as it is at this level; null at all other vertices.
  const LastingCorner* lastingCorner(int vertex) const {
    if (lasting_corners_.empty()) {
      return nullptr;
    }
    const auto known = lasting_corners_.find(vertex);
    return known == lasting_corners_.end() ? nullptr : &known->second;
  }

  /// Whether the vertex has faces all around, and neither it nor an edge at it is sharp. It is
  /// known where the mesh has any sharpness.
  bool isSmooth(int vertex) const { return smooth_[vertex]; }

  /// The number of the vertex's control point, which is made when it is first asked for.
  int point(int vertex) {
    if (vertex < own_points_) {
      return vertex;
    }
    int& point = points_[vertex - own_points_];
    if (point < 0) {
      point = makePoint(vertex);
    }
    return point;
  }

  FaceCorner after(FaceCorner at, int steps) const {
    const int size = faceSize(at.face), corner = at.corner + steps;
    return {at.face, corner < size ? corner : corner - size};
  }
  FaceCorner before(FaceCorner at) const {
    return {at.face, (at.corner == 0 ? faceSize(at.face) : at.corner) - 1};
  }
  int vertexAfter(FaceCorner at, int steps) const { return vertex(after(at, steps)); }

  /// The same vertex's corner in the next face around it, counter-clockwise.
  FaceCorner turned(FaceCorner at) const { return twin(before(at)); }

  /// The edge as a side of the face beyond it, if the surface is smooth across it: there is none at
  /// a boundary and at an infinitely sharp edge.
  FaceCorner across(FaceCorner side) const {
    if (side_sharpness_ && isInfinitelySharp(sharpness(side))) {
      return {};
    }
    return twin(side);
  }

  /// Calls visit(corner) for the faces around a vertex, counter-clockwise.
  template <typename Visit>
  void forEachAround(const VertexFan& fan, const Visit& visit) const {
    FaceCorner at = fan.first;
    for (int i = 0; i < fan.faces; ++i) {
      visit(at);
      if (i + 1 < fan.faces) {
        at = turned(at);
      }
    }
  }

  /// Sets the sharpness of a vertex and of the edges at it: those of its fan, counter-clockwise,
  /// then the others. The memory of `around` is used again.
  void getSharpnessAround(int vertex, SharpnessAround& around) const;

 protected:
  FaceMesh() = default;

  /// Makes the point of a vertex that has none yet.
  virtual int makePoint(int vertex) = 0;

  int vertex_count_ = 0, corner_count_ = 0;
  // Where quads only, the first two are null. Per face, and one more entry; the others per corner.
  const int* first_corners_ = nullptr;
  const int* face_of_corner_ = nullptr;
  const int* corner_vertices_ = nullptr;
  const int* twins_ = nullptr;             ///< the twin's number; -1: none
  const float* side_sharpness_ = nullptr;  ///< null if nothing is sharp
  std::vector<bool> smooth_;               ///< per vertex; empty if nothing is sharp
  // Of the first so many vertices the point has the vertex's number; the next two are about them.
  int own_points_ = 0;
  const Adjacency::Fan* cage_fans_ = nullptr;
  const float* cage_sharpness_ = nullptr;  ///< null if none is sharp
  // Of the other vertices.
  struct StoredFan {
    int first;  ///< the number of the corner
    int faces : 31;
    bool closed : 1;
  };
  std::vector<StoredFan> fans_;
  std::vector<float> fan_sharpness_;  ///< of those that come first; the others are smooth
  std::vector<int> points_;           ///< -1: not made yet
  std::map<int, std::vector<float>> other_fans_edges_;
  std::map<int, CreaseEnds> crease_ends_;
  // As SeamSharpness has them, at this level.
  std::map<int, std::vector<float>> averaged_edges_;
  std::map<int, LastingCorner> lasting_corners_;
};

}  // namespace limitsurf
