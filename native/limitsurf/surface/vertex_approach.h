// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/pose/pose.h"

namespace limitsurf {

/// The directions in which du, dv and their cross product converge on the way u = v = 2^-n, n to
/// infinity, to a ring tile's vertex. Each has any length, or is zero.
struct VertexApproach {
  Vector3 du, dv, normal;
};

/// The approach to the vertex of a ring tile, in the tile's frame turned back by `turns` corners.
///
/// Conjugate and negative eigenvalues lead at interior vertices and darts of two faces, and
/// elsewhere on degenerate meshes alone. There even and odd n approach different directions. Where
/// positive eigenvalues of the same size lead as well, as at interior vertices of two faces, theirs
/// is taken: the mean. Otherwise the terms are taken at those n at which n steps have turned them
/// by whole circles.
VertexApproach vertexApproach(const TileTable& table, const Pose& pose, int ring_tile, int turns);

}  // namespace limitsurf
