// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

/// `count` closest points and rays on a mesh of 10,000 faces, ours beside Embree's on a
/// tessellation, each with its errors; and as many random points. To be called before any thread
/// starts. Returns an exit status.
int measureSearches(int count);

}  // namespace limitsurf::bench
