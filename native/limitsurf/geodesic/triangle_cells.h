// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/geodesic/surface_triangles.h"

namespace limitsurf {

/// Finds the triangle in which a location lies: each Ptex face is divided into 2^n x 2^n cells,
/// which list the triangles that reach into them.
class TriangleCells {
 public:
  /// `levels` are those with which the triangles were made.
  TriangleCells(const LimitSurface& surface, const std::vector<int>& levels,
                const SurfaceTriangles& triangles);

  /// The triangle at a location on a face that has a limit surface. `triangles` are those of the
  /// constructor.
  int find(const SurfaceTriangles& triangles, const Location& at) const;

 private:
  std::vector<std::uint8_t> levels_;     // per Ptex face: n
  std::vector<std::size_t> first_cell_;  // per Ptex face
  std::vector<int> first_, in_cell_;     // per cell: the first of its triangles
};

/// Of some triangles of a Ptex face the one that contains a place of it, or whose side is nearest;
/// -1 if there are none.
int deepest(const SurfaceTriangles& triangles, Span<int> numbers, const Location& at);

}  // namespace limitsurf
