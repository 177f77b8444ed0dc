// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limitsurf/mesh/topology.h"
#include "limitsurf/patch/face_mesh.h"

namespace limitsurf {

/// Level 0: the control mesh itself. A vertex in which several fans meet counts as one vertex for
/// each fan; the numbers of these follow those of the mesh's own vertices.
class CageMesh final : public FaceMesh {
 public:
  CageMesh(const ControlMesh& mesh, const Topology& topology);

  bool onlyQuadsAround(int vertex) const { return (marks_[vertex] & kQuads) != 0; }
  /// Whether the surface around the vertex is a B-spline, provided that all its faces are quads.
  bool regularVertex(int vertex) const { return (marks_[vertex] & kRegular) != 0; }
  /// Whether the face's surface is one B-spline patch, smooth inside.
  bool regularFace(int face) const;
  /// The corners of a regular face that have faces all around.
  std::array<bool, 4> diagonals(int face) const;

 private:
  enum Mark : std::uint8_t { kRegular = 1, kQuads = 2 };

  void splitVertices();
  void setSplitFan(int vertex);
  void mark(int vertex);
  void findSmoothVertices();
  bool isRegular(int vertex) const;

  int makePoint(int vertex) override;

  const Topology& topology_;
  std::vector<int> own_first_corners_;    // if not all faces are quads
  std::vector<int> own_corner_vertices_;  // if there are split vertices
  std::vector<std::uint8_t> marks_;       // per vertex
};

}  // namespace limitsurf
