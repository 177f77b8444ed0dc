// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Polygons on the limit surface. Points come face of the mesh by face, in the order in which that
/// face's polygons first name them.
struct Tessellation {
  /// u and v of a polygon's corner on the polygon's own Ptex face, in parts of kSteps.
  struct Corner {
    static constexpr int kSteps = 4096;
    std::uint16_t u, v;
  };

  Points positions, normals;
  std::vector<Location> locations;  ///< of the points

  std::vector<int> face_sizes;     ///< 3 or 4 corners each
  std::vector<int> face_vertices;  ///< the corners' points, one polygon after the other
  std::vector<int> base_face;      ///< per polygon: the face of the mesh
  std::vector<int> ptex_face;      ///< per polygon: the Ptex face that it lies on
  std::vector<Corner> corners;
  Points corner_normals;  ///< only if asked for

  /// Of a corner, counted over all polygons, which is one of that polygon's.
  Location cornerLocation(std::size_t polygon, std::size_t corner) const;
};

struct TessellationOptions {
  int threads = 0;
  bool corner_normals = false;                  ///< of each polygon's corners as well
  Progress progress{};
};

/// Watertight quads on the limit surface: a quad becomes 2^levels x 2^levels of them, each
/// sub-face of an n-gon half as many a side. Points on shared edges exist once.
///
/// A point's normal is the one seen from its location: one of several along creases, and at
/// irregular vertices without one the direction of frames(). Corner normals are those of each
/// polygon's own face.
///
/// Throws std::invalid_argument for levels below 0, below 1 where the mesh has faces other than
/// quads, or above 12. Memory: 72 bytes a point and 8 a polygon corner, 24 more with corner
/// normals, and 12 a polygon.
Tessellation tessellate(const LimitSurface& surface, int levels,
                        const TessellationOptions& options = {});

/// The same with a level for each face of the mesh; those of refused faces mean nothing. An edge
/// has 2^level segments for the largest level of its faces. In coarser faces cells become smaller
/// towards it, and some of them triangles around their centre (GradedFace tells which). No vertex
/// lies on another polygon's side, and a face's polygons cover it once, oriented as it is.
///
/// Throws std::invalid_argument for another number of levels, and naming the first face whose
/// level is not allowed.
Tessellation tessellate(const LimitSurface& surface, std::vector<int> levels,
                        const TessellationOptions& options = {});

}  // namespace limitsurf
