// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

// The time and the memory that each library takes to open a mesh, in a process of its own. Both
// functions must be called before any thread starts, and return an exit status.

/// Opens a grid of side x side quads, of which one in fifty is irregular.
int measureLargeMesh(int side);

/// Opens a grid of side x side quads whose edges are all semi-sharp.
int measureSemiSharpMesh(int side);

}  // namespace limitsurf::bench
