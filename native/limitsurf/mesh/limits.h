// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// OpenSubdiv counts the edges of a vertex and the corners of a face in 16 bits.
constexpr int kMaxValence = 65535;

/// Indices are 32 bits wide; refined vertices (one per vertex, edge and face) must fit as well.
constexpr int kMaxCorners = 500'000'000;

}  // namespace limitsurf
