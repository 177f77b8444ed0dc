// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// Where face-varying data are linear: OpenSubdiv's FVAR_LINEAR_* rules. They apply to the values
/// along seams and boundaries; everywhere else data are as smooth as the surface.
enum class Interpolation {
  none,           ///< nowhere: seams are smooth curves, also around corners of one face
  corners_only,   ///< values with one face at a vertex are pinned
  corners_plus1,  ///< as before, and at junctions (vertices with more than two values), and where
                  ///< the other value at the vertex is sharp
  corners_plus2,  ///< as before, and at the inner ends of seams, and both values at a vertex where
                  ///< one of them is a corner
  boundaries,     ///< seams and boundaries are straight from value to value
  all,            ///< everywhere: bilinear on each Ptex face
};

}  // namespace limitsurf
