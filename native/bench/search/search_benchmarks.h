// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace limitsurf::bench {

/// `count` closest points and rays on a mesh of 10,000 faces, ours beside Embree's on a
/// tessellation, each with its errors; and as many random points. To be called before any thread
/// starts. Returns an exit status.
int measureSearches(int count);

/// Writes the mesh of these searches and so many queries of each kind as numpy's files into an
/// existing folder: besides the mesh (MeshArrays::save()) ROW.origins.npy, and ROW.directions.npy
/// of rays, which has no rows for closest points. ROW is closest-far, closest-near, rays-above or
/// rays-all-sides.
void saveSearches(const std::string& folder, int count);

}  // namespace limitsurf::bench
