// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf::bench {

/// Prints what rasterising and looking up UV maps costs, on all cores, beside the triangles of a
/// level-4 tessellation with barycentric coordinates in an image of the same size: `side` x `side`
/// texels. The exit status.
int measureUvMaps(int side);

}  // namespace limitsurf::bench
