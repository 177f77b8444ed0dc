// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// One level of refinement: its topology and its sharpness.
class FaceMesh {
 public:
  virtual ~FaceMesh() = default;

  virtual int faceSize(int face) const = 0;
  virtual int vertex(FaceCorner at) const = 0;
  /// Consecutive numbers for all corners of all faces.
  virtual int cornerNumber(FaceCorner at) const = 0;
  virtual int cornerCount() const = 0;
  virtual int vertexCount() const = 0;
  /// The same edge as a side of the face beyond it. There is none on a boundary and at an edge that
  /// is not manifold.
  virtual FaceCorner twin(FaceCorner side) const = 0;
  /// The sharpness of the edge; infinite where the side has no twin.
  virtual float sharpness(FaceCorner side) const = 0;

  virtual VertexFan fan(int vertex) const = 0;
  virtual bool onlyQuadsAround(int vertex) const = 0;
  /// The sharpness of those edges at the vertex that belong to none of its fan's faces.
  virtual std::vector<float> edgesOfOtherFans(int vertex) const = 0;

  /// The number of the vertex's control point.
  virtual int point(int vertex) = 0;

  FaceCorner after(FaceCorner at, int steps) const {
    return {at.face, (at.corner + steps) % faceSize(at.face)};
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
    return isInfinitelySharp(sharpness(side)) ? FaceCorner{} : twin(side);
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

  /// The sharpness around a vertex: that of its fan's edges, counter-clockwise, then that of the
  /// other edges at the vertex.
  SharpnessAround sharpnessAround(int vertex) const;
};

}  // namespace limitsurf
