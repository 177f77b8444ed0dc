// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// Numbers for the vertices of a subdivided mesh: first the mesh's own, then those within its
/// edges, then those within its faces.
class SubdividedVertices {
 public:
  /// `levels` is 1 at least. Throws MeshError for more than 2^31 vertices.
  SubdividedVertices(const ControlMesh& mesh, int levels);

  /// The vertex (i, j) / side of a part (Ptex face) of a face, 0 <= i, j <= side, where side is
  /// 2^levels for quads and half as much for others' parts.
  int at(int face, int part, int i, int j) const;

 private:
  int onEdge(int face, int edge, int step) const;
  int onQuad(int face, int i, int j) const;
  int onPart(int face, int part, int i, int j) const;

  const ControlMesh& mesh_;
  int per_edge_;                   ///< polygons along an edge of the mesh
  std::vector<int> edge_at_;       ///< for each corner, the edge that leaves it
  std::vector<int> first_within_;  ///< vertex within each face
};

}  // namespace limitsurf
