// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limitsurf/mesh/control_mesh.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf::test {

/// A control mesh in a form that tests can build and change easily.
struct Cage {
  Points positions;
  std::vector<std::vector<int>> faces;
  MeshOptions options;

  int vertexCount() const { return static_cast<int>(positions.rows()); }
};

ControlMesh controlMesh(const Cage& cage);
LimitSurface limitSurface(const Cage& cage);

/// Length of the diagonal of the bounding box.
double diagonal(const Points& positions);

/// The numbering of Ptex faces: a quad has one, an n-gon n.
struct PtexFace {
  int base_face;
  int corner;
  bool quad;
};
std::vector<PtexFace> ptexFaces(const Cage& cage);

/// Whether every edge has at most two faces, of equal winding, and every vertex one fan of faces.
bool isManifold(const std::vector<std::vector<int>>& faces);

/// (u, v) of a Ptex face's corner.
Location cornerLocation(int face, int corner);

std::string describe(const Location& location);

}  // namespace limitsurf::test
