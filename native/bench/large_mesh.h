// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

// Time and memory that each library takes to open a mesh, in a process of its own; to be called
// before any thread starts. Both return an exit status.

/// A grid of side x side quads, one in fifty irregular.
int measureLargeMesh(int side);

/// A grid of side x side quads on which every edge is semi-sharp.
int measureSemiSharpMesh(int side);

}  // namespace limitsurf::bench
