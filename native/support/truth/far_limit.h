// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cages/cage.h"

namespace limitsurf::test {

/// Points of the limit surface by OpenSubdiv: its uniform refinement in double, then its limit
/// masks, at the vertices of the refined mesh.
///
/// Its masks are wrong for positions at interior valence 2 and at darts, for tangents at boundary
/// and crease vertices of three and more faces, and wherever sharpness has not decayed after
/// `level` levels. With Creasing::chaikin it extrapolates where sharpness above 1 decays to 0.
struct FarLimit {
  std::vector<Location> at;
  Points position, tangent1, tangent2;
};

FarLimit farLimit(const Cage& cage, int level);

}  // namespace limitsurf::test
