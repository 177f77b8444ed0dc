// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// The numbered edges of a control mesh: pairs of vertices that follow each other around a face.
struct CageEdges {
  explicit CageEdges(const ControlMesh& mesh);

  std::vector<int> of_corner;  ///< for each corner of each face, the edge to the face's next corner
  int count = 0;
};

}  // namespace limitsurf
