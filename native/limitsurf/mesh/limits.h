// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// OpenSubdiv counts the edges of a vertex and the corners of a face in 16 bits.
constexpr int kMaxValence = 65535;

/// The most vertices and the most face corners of a mesh. Indices are 32 bits wide, and those of
/// refined vertices (one for each vertex, edge and face) have to fit as well. A mesh has no more
/// edges than corners and a third as many faces, so that they are fewer than 2^31.
constexpr int kMaxCorners = 500'000'000;

}  // namespace limitsurf
