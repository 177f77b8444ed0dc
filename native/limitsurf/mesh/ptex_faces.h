// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf {

/// The numbers of a mesh's Ptex faces.
struct PtexFaces {
  explicit PtexFaces(const ControlMesh& mesh);
  std::vector<int> base_face, corner;  ///< per Ptex face
  std::vector<int> first;              ///< per face of the mesh; one more at the end
};

}  // namespace limitsurf
