// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/curves/mesh_edges.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// A side of a Ptex face: the location at x in [0, 1] along it is origin + x direction.
struct FaceSide {
  int face = -1;
  double u0 = 0, v0 = 0, du = 0, dv = 0;

  /// Side k of a Ptex face, from its corner k to the next.
  static FaceSide of(int face, int k) {
    switch (k & 3) {
      case 0:
        return {face, 0, 0, 1, 0};
      case 1:
        return {face, 1, 0, 0, 1};
      case 2:
        return {face, 1, 1, -1, 0};
      default:
        return {face, 0, 1, 0, -1};
    }
  }

  Location at(double x) const { return {face, u0 + du * x, v0 + dv * x}; }
};

/// The sides of Ptex faces that an edge consists of, as a face of the control mesh uses it: one
/// side of a quad, or two halves, of neighbouring sub-faces of an n-gon.
struct EdgeSides {
  int count = 1;
  FaceSide sides[2];

  EdgeSides(const ControlMesh& mesh, int first_ptex_face, const MeshEdges::Use& use) {
    const int size = mesh.faceSize(use.face);
    if (size == 4) {
      sides[0] = FaceSide::of(first_ptex_face, use.corner);
    } else {
      count = 2;
      sides[0] = FaceSide::of(first_ptex_face + use.corner, 0);
      sides[1] = FaceSide::of(first_ptex_face + (use.corner + 1) % size, 3);
    }
  }

  /// The location at a fraction of the edge, in the face's own direction.
  Location at(double fraction) const {
    if (count == 1) {
      return sides[0].at(fraction);
    }
    return fraction < 0.5 ? sides[0].at(2 * fraction) : sides[1].at(2 * fraction - 1);
  }
};

}  // namespace limitsurf
