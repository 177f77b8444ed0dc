// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/cage.h"

namespace limitsurf::test {

/// Points of the limit surface by OpenSubdiv: its uniform refinement in double, then its limit
/// masks, at the vertices of the refined mesh.
///
/// Its masks are wrong for positions at interior valence 2, and for tangents at boundary vertices
/// of three and more faces.
struct FarLimit {
  std::vector<Location> at;
  Points position, tangent1, tangent2;
};

FarLimit farLimit(const Cage& cage, int level);

}  // namespace limitsurf::test
