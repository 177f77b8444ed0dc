// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limitsurf {

/// Ids of the faces and vertices of one level of refinement. A level is never built as a whole, so
/// its ids need not be consecutive.
using FaceId = std::int64_t;
using VertexId = std::int64_t;

struct FaceCorner {
  FaceId face = -1;
  int corner = 0;

  bool exists() const { return face >= 0; }
};

/// The topology of one level of refinement, answered on demand. Only faces whose vertices are
/// manifold may be asked about.
class FaceMesh {
 public:
  virtual ~FaceMesh() = default;

  virtual int faceSize(FaceId face) const = 0;
  virtual VertexId vertex(FaceCorner at) const = 0;

  /// The faces around a vertex, counter-clockwise; on a boundary from the first to the last.
  virtual int facesAt(VertexId vertex) const = 0;
  virtual bool interior(VertexId vertex) const = 0;
  virtual FaceCorner faceAt(VertexId vertex, int i) const = 0;
  /// Whether the vertex, on a boundary, stays where it is.
  virtual bool pinned(VertexId vertex) const = 0;
  /// The i for which faceAt(vertex(at), i) is `at`.
  virtual int positionOf(FaceCorner at) const = 0;

  /// The number of the vertex's control point.
  virtual int point(VertexId vertex) = 0;

  VertexId vertexAfter(FaceCorner at, int steps) const {
    return vertex({at.face, (at.corner + steps) % faceSize(at.face)});
  }
};

/// The faces around a corner of a face, counted from that face: +1 is the next one counter-clockwise,
/// beyond the edge to the corner before; -1 the one beyond the edge to the corner after.
class Fan {
 public:
  Fan(const FaceMesh& mesh, FaceCorner at)
      : mesh_(mesh),
        vertex_(mesh.vertex(at)),
        count_(mesh.facesAt(vertex_)),
        interior_(mesh.interior(vertex_)),
        pinned_(mesh.pinned(vertex_)),
        position_(mesh.positionOf(at)) {}

  VertexId vertex() const { return vertex_; }
  int count() const { return count_; }
  bool interior() const { return interior_; }
  bool pinned() const { return pinned_; }
  /// Where the face stands among the vertex's faces.
  int position() const { return position_; }

  /// Does not exist beyond a boundary.
  FaceCorner at(int offset) const {
    int i = position_ + offset;
    if (interior_) {
      i = ((i % count_) + count_) % count_;
    } else if (i < 0 || i >= count_) {
      return {};
    }
    return mesh_.faceAt(vertex_, i);
  }

  bool allQuads() const {
    for (int i = 0; i < count_; ++i) {
      if (mesh_.faceSize(mesh_.faceAt(vertex_, i).face) != 4) {
        return false;
      }
    }
    return true;
  }

 private:
  const FaceMesh& mesh_;
  VertexId vertex_;
  int count_;
  bool interior_, pinned_;
  int position_;
};

}  // namespace limitsurf
