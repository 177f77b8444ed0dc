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

/// Whether du = dv = 0 at the vertex: all its modes shrink by more than half a step.
bool vertexIsStationary(const Ring& ring);

/// Whether all approaches to the vertex within its sector agree on a normal: everywhere inside but
/// at valence 2, and in boundary sectors of up to three faces (paper's valence 4).
bool vertexHasNormal(const Ring& ring);

/// What the surface looks like on the way u = v = 2^-n, n to infinity, to a ring tile's vertex: the
/// directions (any length, or zero) of du, dv and of their cross product in the tile's frame turned
/// by `turns` corners back.
struct VertexApproach {
  Vector3 du, dv, normal;
};
VertexApproach vertexApproach(const TileTable& table, const Pose& pose, int ring_tile, int turns);

}  // namespace limitsurf
