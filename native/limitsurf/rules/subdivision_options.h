// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

enum class Boundary {
  smooth,   ///< every boundary is a uniform cubic B-spline curve, corners rounded (EDGE_ONLY)
  corners,  ///< boundary vertices with one face are pinned (EDGE_AND_CORNER)
};

enum class Creasing {
  uniform,  ///< a child edge's sharpness is its parent's less 1
  chaikin,  ///< before that, it is averaged with the sharp edges at the end vertex
};

enum class Triangles {
  catmark,  ///< Catmull-Clark's own edge rule everywhere
  smooth,   ///< OpenSubdiv's TRI_SUB_SMOOTH: other edge weights beside triangles
};

/// The choices that Catmull-Clark subdivision leaves open, as OpenSubdiv's Sdc has them.
struct SubdivisionOptions {
  Boundary boundary = Boundary::smooth;
  Creasing creasing = Creasing::uniform;
  Triangles triangles = Triangles::catmark;
};

}  // namespace limitsurf
