// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

/// Opens a grid of side x side quads, one in fifty irregular, with each library in a process of its
/// own, and prints time and memory. Returns an exit status. To be called before any thread starts.
int measureLargeMesh(int side);

}  // namespace limitsurf::bench
