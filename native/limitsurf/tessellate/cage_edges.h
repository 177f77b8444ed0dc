// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// Numbers the edges of a control mesh: pairs of vertices that follow each other around a face.
struct CageEdges {
  explicit CageEdges(const ControlMesh& mesh);

  std::vector<int> of_corner;  ///< the edge from each corner of each face to the face's next
  int count = 0;
};

}  // namespace limitsurf
