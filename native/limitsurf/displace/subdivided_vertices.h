// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// A numbering of the vertices of a subdivided mesh: first the vertices of the mesh, then those
/// within its edges, then those within its faces.
class SubdividedVertices {
 public:
  /// `levels` must be at least 1. Throws MeshError for more than 2^31 vertices.
  SubdividedVertices(const ControlMesh& mesh, int levels);

  /// The vertex at (u, v) = (i, j) / side of a part (Ptex face) of a face, 0 <= i, j <= side, where
  /// side is 2^levels on a quad, and half of that on the parts of other faces.
  int at(int face, int part, int i, int j) const;

 private:
  int onEdge(int face, int edge, int step) const;
  int onQuad(int face, int i, int j) const;
  int onPart(int face, int part, int i, int j) const;

  const ControlMesh& mesh_;
  int per_edge_;                   ///< the number of polygons along an edge of the mesh
  std::vector<int> edge_at_;       ///< for each corner, the edge that leaves it
  std::vector<int> first_within_;  ///< for each face, the first vertex inside it
};

}  // namespace limitsurf
