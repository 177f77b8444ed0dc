// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/pose/pose.h"

namespace limitsurf {

/// Position and derivatives exactly at a ring tile's extraordinary vertex, in the tile's turned
/// frame. Along a boundary that bounds the tile they are those of the limit curve; at interior
/// valence 2 and 3, du = dv = 0; all others have no limit and are NaN.
void vertexJet(const TileTable& table, const Pose& pose, int ring_tile, Jet& jet);

/// Whether du = dv = 0 at the vertex. This is so at interior valence 2 and 3, whose eigenvalues
/// other than 1 are all below 1/2. (Those of darts of these valences are as well, but the
/// derivatives of darts count as undefined.)
bool vertexIsStationary(const Ring& ring);

/// Whether all approaches to the vertex within its sector agree on a normal. They do at interior
/// vertices and darts of valence 3 and more, in boundary sectors of at most three faces (valence
/// 4), and in pinned corners of one face; never at cones, tips and loops.
///
/// At a tip the mode with the largest eigenvalue, (3 + sqrt 5) / 8, is the same in all directions,
/// as at a cone. The two leading modes of a loop of up to three faces map its two halves onto each
/// other, those of a larger one fold as in a boundary sector.
///
/// At a dart the two largest eigenvalues below 1 belong to an antisymmetric and a symmetric mode,
/// and the map that these two modes make preserves the orientation everywhere.
bool vertexHasNormal(const Ring& ring);

}  // namespace limitsurf
