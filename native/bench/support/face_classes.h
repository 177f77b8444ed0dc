// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/support/mesh_arrays.h"

namespace limitsurf::bench {

enum class FaceClass {
  regular,       ///< no EV; faces at boundaries included
  interior_ev,   ///< one EV, inside the mesh
  boundary_ev,   ///< one EV, on the boundary, of valence 4 and more
  corner,        ///< one EV, a boundary vertex of valence 2
  multi_ev,      ///< several EVs
  polygon,       ///< a sub-face of an n-gon
  near_polygon,  ///< a quad that shares a vertex with an n-gon
};

/// A Ptex face with its class.
struct ClassifiedFace {
  FaceClass face_class;
  int ev_corner;  ///< the corner of the EV if the face has exactly one; else -1
};

/// The classes of all Ptex faces.
std::vector<ClassifiedFace> classifyFaces(const MeshArrays& cage);

/// The Ptex faces of one class.
std::vector<int> facesOf(const std::vector<ClassifiedFace>& faces, FaceClass face_class);

}  // namespace limitsurf::bench
