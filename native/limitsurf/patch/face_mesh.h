// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limitsurf {

/// Ids of the faces and vertices of one level of refinement. A level is never built as a whole, so
/// its ids need not be consecutive.
using FaceId = std::int64_t;
using VertexId = std::int64_t;

/// A corner of a face. As a side of the face it stands for the edge from this corner to the next.
struct FaceCorner {
  FaceId face = -1;
  int corner = 0;

  bool exists() const { return face >= 0; }
};

/// What surrounds a vertex.
struct VertexFan {
  int faces;
  bool interior;  ///< faces all around
  bool pinned;    ///< on a boundary, and does not move

  /// Whether the surface around the vertex, if all its faces are quads, is a B-spline's.
  bool regular() const { return faces == (interior ? 4 : pinned ? 1 : 2); }
};

/// The topology of one level of refinement, answered on demand. Only faces whose vertices are
/// manifold may be asked about.
class FaceMesh {
 public:
  virtual ~FaceMesh() = default;

  virtual int faceSize(FaceId face) const = 0;
  virtual VertexId vertex(FaceCorner at) const = 0;
  /// The same edge as a side of the face beyond it; does not exist on a boundary.
  virtual FaceCorner twin(FaceCorner side) const = 0;

  virtual VertexFan fan(VertexId vertex) const = 0;
  virtual bool onlyQuadsAround(VertexId vertex) const = 0;
  /// The faces around a vertex, counter-clockwise; on a boundary from the first to the last.
  virtual FaceCorner faceAt(VertexId vertex, int i) const = 0;
  /// The i for which faceAt(vertex(at), i) is `at`. Irregular vertices only.
  virtual int positionOf(FaceCorner at) const = 0;

  /// The number of the vertex's control point.
  virtual int point(VertexId vertex) = 0;

  FaceCorner after(FaceCorner at, int steps) const {
    return {at.face, (at.corner + steps) % faceSize(at.face)};
  }
  FaceCorner before(FaceCorner at) const {
    return {at.face, (at.corner == 0 ? faceSize(at.face) : at.corner) - 1};
  }
  VertexId vertexAfter(FaceCorner at, int steps) const { return vertex(after(at, steps)); }

  /// The same vertex's corner in the next face around it, counter-clockwise.
  FaceCorner turned(FaceCorner at) const { return twin(before(at)); }
  /// In the next face clockwise.
  FaceCorner turnedBack(FaceCorner at) const {
    const FaceCorner side = twin(at);
    return side.exists() ? after(side, 1) : side;
  }
};

}  // namespace limitsurf
