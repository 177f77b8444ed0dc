// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cages.h"

namespace limitsurf::bench {

enum class FaceClass {
  regular,       ///< no EV; open boundaries included
  interior_ev,   ///< one EV, inside the mesh
  boundary_ev,   ///< one EV, on the boundary, of valence 4 and more
  corner,        ///< one EV, a boundary vertex of valence 2
  multi_ev,      ///< several EVs
  polygon,       ///< sub-face of an n-gon
  near_polygon,  ///< a quad that shares a vertex with an n-gon
};

/// A Ptex face with its class.
struct ClassifiedFace {
  FaceClass face_class;
  int ev_corner;  ///< the EV's corner, of faces with exactly one; else -1
};

/// One entry per Ptex face.
std::vector<ClassifiedFace> classifyFaces(const Cage& cage);

/// The Ptex faces of one class.
std::vector<int> facesOf(const std::vector<ClassifiedFace>& faces, FaceClass face_class);

}  // namespace limitsurf::bench
