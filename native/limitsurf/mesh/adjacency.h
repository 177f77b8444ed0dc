// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// Which faces of a control mesh meet, corner by corner. Corners are numbered as in
/// ControlMesh::faceVertices(); a corner also stands for the side of its face from it to the next.
struct Adjacency {
  /// The faces around a vertex, counter-clockwise.
  struct Fan {
    int first = -1;  ///< a corner; on a boundary that of the first face. -1: no faces
    int faces = 0;
    bool closed = true;
  };

  std::vector<int> face_of_corner;  ///< empty if all faces are quads
  std::vector<int> twins;           ///< per corner: the same edge as a side of another face, or -1
  std::vector<Fan> fans;            ///< per vertex

  /// Of a manifold mesh: each edge has at most two faces, of the same winding, each vertex has one
  /// fan of faces, and no face names a vertex twice. Nothing for any other mesh.
  ///
  /// Fans begin where those of OpenSubdiv's Far do. Cost: O(corners), whatever the valences are:
  /// the two faces of an edge find each other at that of its ends which has fewer faces.
  static std::optional<Adjacency> ofManifold(const ControlMesh& mesh);

  /// Sets face_of_corner.
  void findFaces(const ControlMesh& mesh);

  int face(int corner) const {
    return face_of_corner.empty() ? corner / 4 : face_of_corner[corner];
  }
  /// The next and the previous corner of the same face.
  int next(const ControlMesh& mesh, int corner) const {
    if (face_of_corner.empty()) {
      return corner % 4 == 3 ? corner - 3 : corner + 1;
    }
    const int at = face_of_corner[corner], first = mesh.firstCorner(at);
    return corner + 1 == first + mesh.faceSize(at) ? first : corner + 1;
  }
  int previous(const ControlMesh& mesh, int corner) const {
    if (face_of_corner.empty()) {
      return corner % 4 == 0 ? corner + 3 : corner - 1;
    }
    const int at = face_of_corner[corner], first = mesh.firstCorner(at);
    return (corner == first ? first + mesh.faceSize(at) : corner) - 1;
  }

  /// One of the sides that the edge between two vertices of a manifold mesh is. Cost: O(faces at
  /// `begin`).
  int side(const ControlMesh& mesh, int begin, int end) const;

  class Builder;
};

}  // namespace limitsurf
