// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Polygons on the limit surface. Points stand in the order of the mesh's faces, those of a face in
/// the order in which its polygons first use them.
struct Tessellation {
  /// (u, v) of a polygon's corner on the polygon's own Ptex face, in parts of kSteps.
  struct Corner {
    static constexpr int kSteps = 4096;
    std::uint16_t u, v;
  };

  Points positions, normals;
  std::vector<Location> locations;  ///< one for each point

  std::vector<int> face_sizes;     ///< the number of corners of each polygon, 3 or 4
  std::vector<int> face_vertices;  ///< the corners' points, one polygon after the other
  std::vector<int> base_face;      ///< per polygon: the face of the mesh
  std::vector<int> ptex_face;      ///< per polygon: the Ptex face that it lies on
  std::vector<Corner> corners;
  Points corner_normals;  ///< no rows unless asked for

  /// The location of a corner of a polygon. Corners are counted over all polygons.
  Location cornerLocation(std::size_t polygon, std::size_t corner) const;
};

struct TessellationOptions {
  int threads = 0;
  bool corner_normals = false;  ///< compute a normal for each corner of each polygon as well
  Progress progress{};
};

/// Watertight quads on the limit surface: a quad becomes 2^levels x 2^levels of them, and each
/// sub-face of an n-gon half as many a side. Points on shared edges exist only once.
///
/// The normal of a point is the surface's at the point's location: one of several along creases,
/// and that of frames() at irregular vertices without a normal. The normal of a corner is that of
/// the polygon's own face.
///
/// Throws std::invalid_argument for levels below 0, below 1 if the mesh has faces other than quads,
/// or above 12. Memory: 72 bytes a point, 12 a polygon, and 8 for each corner of a polygon, 24 more
/// with normals of corners.
Tessellation tessellate(const LimitSurface& surface, int levels,
                        const TessellationOptions& options = {});

/// The same with a level for each face of the mesh; the levels of refused faces are ignored. An
/// edge has 2^level segments for the largest level of its faces. On a coarser face the quads become
/// smaller towards such an edge, and some of them become triangles around their centre. No vertex
/// lies on the side of another polygon, and the polygons of a face cover it once, with its
/// orientation.
///
/// Throws std::invalid_argument for another number of levels, and naming the first face whose level
/// is not allowed.
Tessellation tessellate(const LimitSurface& surface, std::vector<int> levels,
                        const TessellationOptions& options = {});

}  // namespace limitsurf
