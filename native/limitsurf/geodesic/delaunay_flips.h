// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limitsurf/geodesic/surface_triangles.h"

namespace limitsurf {

/// A triangle in the surface that some triangles make up. It may lie on several of them, which are
/// then unfolded into its plane: its sides are straight there, and cross sides of theirs.
struct FlatTriangle {
  std::array<int, 3> vertices;
  std::array<double, 3> sides;  ///< the length from each vertex to the next
};

/// Replaces pairs of triangles that share a side by the other two triangles of the same four
/// corners, as long as the angles opposite the side are together far larger than 180 degrees
/// (intrinsic Delaunay flips; Fisher, Springborn, Bobenko, Schroeder: "An algorithm for the
/// construction of intrinsic Delaunay triangulations", 2006). Long thin triangles, as around a
/// pole, have such angles of almost 180 degrees. The vertices stay, and so do cut sides, borders,
/// and sides of three and more triangles.
///
/// Returns the triangles that are new. Well-shaped triangles give none. The points of `triangles`
/// must be its vertices, as in GeodesicMesh. Cost: O(triangles); not more than kMostFlips for each.
std::vector<FlatTriangle> flippedTriangles(const SurfaceTriangles& triangles);

}  // namespace limitsurf
