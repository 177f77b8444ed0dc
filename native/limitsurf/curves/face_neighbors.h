// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limitsurf/curves/edge_place.h"
#include "limitsurf/curves/mesh_edges.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// For each face of a control mesh the number of its first Ptex face.
std::vector<int> firstPtexFaces(const LimitSurface& surface);

/// What lies beyond the sides of Ptex faces.
class FaceNeighbors {
 public:
  /// Refers to the surface.
  explicit FaceNeighbors(const LimitSurface& surface);

  struct Beyond {
    int edge = -1;  ///< the edge of the control mesh on which the side lies, or -1 within an n-gon
    std::optional<FaceSide> side;  ///< of the neighbour, if there is exactly one
    double x = 0;                  ///< the same place along its side
  };
  /// Side k of a Ptex face leads from its corner k to the next; x runs along it.
  Beyond beyond(int face, int k, double x) const;

  const MeshEdges& edges() const { return edges_; }

 private:
  const LimitSurface& surface_;
  MeshEdges edges_;
  std::vector<int> first_ptex_;
};

}  // namespace limitsurf
