// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose.h"

namespace limitsurf {

/// Position and derivatives exactly at a ring tile's extraordinary vertex, in the tile's turned
/// frame: those of the limit curve along a bounding boundary; du = dv = 0 at interior valence 2
/// and 3; NaN for all that has no limit.
void vertexJet(const TileTable& table, const Pose& pose, int ring_tile, Jet& jet);

/// Whether du = dv = 0 at the vertex: at smooth valence 2 and 3, all of whose eigenvalues are below
/// 1/2. (So are those of darts of these valences, but a dart's derivatives count as undefined.)
bool vertexIsStationary(const Ring& ring);

/// Whether all approaches to the vertex within its sector agree on a normal: everywhere inside, at
/// darts as well, but at valence 2, and in boundary sectors of up to three faces (paper's valence
/// 4); nowhere at cones.
///
/// At a dart the two largest eigenvalues belong to an antisymmetric and a symmetric mode, and the
/// map that those make turns over nowhere.
bool vertexHasNormal(const Ring& ring);

/// What the surface looks like on the way u = v = 2^-n, n to infinity, to a ring tile's vertex: the
/// directions (any length, or zero) of du, dv and of their cross product in the tile's frame turned
/// by `turns` corners back. Conjugate and negative eigenvalues, which never lead unless a mesh is
/// degenerate, are seen where n steps have turned them by whole circles.
struct VertexApproach {
  Vector3 du, dv, normal;
};
VertexApproach vertexApproach(const TileTable& table, const Pose& pose, int ring_tile, int turns);

}  // namespace limitsurf
