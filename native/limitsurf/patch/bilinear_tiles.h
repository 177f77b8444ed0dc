// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/patch/tile_table.h"

namespace limitsurf {

/// The tiles of the bilinear scheme: each Ptex face is the bilinear patch of its four corners,
/// which is also the B-spline patch of a quad without neighbours whose corners are pinned.
TileTable buildBilinearTiles(const ControlMesh& mesh, const Topology& topology,
                             const PtexFaces& ptex);

}  // namespace limitsurf
