// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

/// Prints the cost of rasterising UV maps and of searching them for points, on all cores, beside
/// the rasterisation of a level-4 tessellation's triangles with barycentric coordinates, for images
/// of `side` x `side` texels. Returns the exit status.
int measureUvMaps(int side);

}  // namespace limitsurf::bench
