// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limitsurf/patch/cage_mesh.h"
#include "limitsurf/patch/refined_mesh.h"
#include "limitsurf/patch/sectors.h"

namespace limitsurf {

/// A level of refinement, with what is known of its vertices.
struct RefinementLevel {
  RefinementLevel(CageMesh& cage_mesh, bool is_sharp)
      : mesh(cage_mesh), cage(&cage_mesh), sectors(cage_mesh, is_sharp), has_sharpness(is_sharp) {}
  RefinementLevel(RefinedMesh& refined_mesh, bool is_sharp)
      : mesh(refined_mesh),
        refined(&refined_mesh),
        sectors(refined_mesh, is_sharp),
        has_sharpness(is_sharp) {}

  bool onlyQuadsAround(int vertex) const { return !cage || cage->onlyQuadsAround(vertex); }

  FaceMesh& mesh;
  const CageMesh* cage = nullptr;  ///< the mesh, if it is the cage, or
  RefinedMesh* refined = nullptr;  ///< if it is not
  Sectors sectors;
  bool has_sharpness;

  /// A ring of the table, and how many steps before this level its points were taken.
  struct RingAge {
    int ring = -1, steps = 0;
  };
  std::vector<RingAge> rings;  ///< per sector
};

/// What decides whether a quad is one tile.
struct QuadCorners {
  std::array<bool, 4> diagonal = {false, false, false, false};  ///< as Window takes it
  int irregular = 0, irregular_corner = -1;  ///< how many corners are irregular, and one of them
  int creases = 0, crease_side = -1;         ///< how many sides are semi-sharp, and one of them
  bool is_tile = true;
};

/// Looks at the corners and sides of a quad. Where the quad is no tile, only `is_tile` is set.
QuadCorners cornersOf(RefinementLevel& level, int quad);

}  // namespace limitsurf
