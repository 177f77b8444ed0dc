// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "support/cages/cage.h"

namespace limitsurf::test {

using NamedCages = std::vector<std::pair<std::string, Cage>>;

/// Cages whose faces all have a limit surface, though their edges have three and four faces or
/// faces of opposite winding, or their vertices several fans of faces, open or closed. All faces
/// have different vertices.
NamedCages nonManifoldCages();

/// Quads that share one edge, the edge of the vertices 0 and 1.
Cage book(int pages);

/// Fans of faces at a vertex in the middle of a crease where three sheets meet, which is not their
/// own boundary on both sides: closed ones, and others that begin and end at the same edge of the
/// crease. OpenSubdiv 3.5 moves the vertex along that crease, later versions do not.
NamedCages fansOnACrease();

/// 4x4 squares whose sixth face is given instead by these corners of its own: {0, 1, 2, 1}, say,
/// uses its second vertex twice.
Cage gridWithFace(const std::vector<int>& corners);

}  // namespace limitsurf::test
