// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/mesh/ptex_faces.h"

namespace limitsurf {

PtexFaces::PtexFaces(const ControlMesh& mesh) {
  for (int face = 0; face < mesh.faceCount(); ++face) {
    first.push_back(static_cast<int>(base_face.size()));
    const int size = mesh.faceSize(face);
    for (int c = 0; c < (size == 4 ? 1 : size); ++c) {
      base_face.push_back(face);
      corner.push_back(c);
    }
  }
  first.push_back(static_cast<int>(base_face.size()));
}

}  // namespace limitsurf
