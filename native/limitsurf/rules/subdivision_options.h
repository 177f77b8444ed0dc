// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// How the surface ends.
enum class Boundary {
  smooth,   ///< every boundary is a uniform cubic B-spline curve, corners rounded (EDGE_ONLY)
  corners,  ///< boundary vertices with one face are pinned (EDGE_AND_CORNER)
};

/// How the sharpness of edges decays.
enum class Creasing {
  uniform,  ///< the sharpness of a child edge is its parent's minus 1
  chaikin,  ///< before 1 is subtracted, it is averaged with that of the semi-sharp edges at the end
            ///< vertex
};

/// Which weights edges beside triangles have.
enum class Triangles {
  catmark,  ///< Catmull-Clark's own edge rule everywhere
  smooth,   ///< OpenSubdiv's TRI_SUB_SMOOTH: other edge weights beside triangles
};

/// The choices that Catmull-Clark subdivision leaves open, as OpenSubdiv's Sdc offers them.
struct SubdivisionOptions {
  Boundary boundary = Boundary::smooth;
  Creasing creasing = Creasing::uniform;
  Triangles triangles = Triangles::catmark;
};

}  // namespace limitsurf
