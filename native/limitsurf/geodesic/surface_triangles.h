// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limitsurf/geodesic/cut_edges.h"
#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Triangles with their vertices on the limit surface, which cover it once, and the sides of them
/// that no way crosses.
struct SurfaceTriangles {
  /// (u, v) of a triangle's corner on the triangle's own Ptex face, in parts of kOne.
  struct Corner {
    static constexpr std::int32_t kOne = std::int32_t{1} << 30;
    std::int32_t u, v;
  };

  std::vector<Vector3> points;
  std::vector<std::array<int, 3>> vertices;    ///< the points of each triangle
  std::vector<std::array<Corner, 3>> corners;  ///< per triangle
  std::vector<std::array<std::uint8_t, 3>>
      is_cut;             ///< per triangle: the side from a corner to the next
  std::vector<int> face;  ///< per triangle: its Ptex face
};

/// Divides the surface: `levels` are those of tessellate(), one for each face of the control mesh.
/// Sides on the edges `cuts` are cut. Throws MeshError for cuts that are no edges of the mesh.
SurfaceTriangles surfaceTriangles(const LimitSurface& surface, const std::vector<int>& levels,
                                  const EdgeList& cuts, int threads, const Progress& progress);

/// The barycentric coordinates of a place of a triangle's Ptex face with respect to its corners.
/// They are not finite for a triangle without area.
std::array<double, 3> barycentric(const std::array<SurfaceTriangles::Corner, 3>& corners, double u,
                                  double v);

}  // namespace limitsurf
