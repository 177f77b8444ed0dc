// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/tiles/surface_tiles.h"

namespace limitsurf {

/// All tiles of a surface, and for each Ptex face the quadtree that leads from (u, v) to its tile:
/// what another program needs to evaluate the limit surface at locations that it finds itself.
///
/// Node f is Ptex face f as a whole. To find the tile of (u, v) begin at its face's node, and go
/// on while child[node] >= 0: with a = 1 where u >= 1/2, else 0, and b likewise for v, the next
/// node is child[node] + 2 b + a, and (u, v) becomes (2 u - a, 2 v - b). At the end the tile is -1
/// - child[node], and the place in it is ((u, v) of the face - origin.row(tile)) * scale, where
/// `scale` is that of the tile, cut off at 0 and 1.
struct TileQuadtree {
  /// In `child`, for faces that have no limit surface. Single precision holds it exactly.
  static constexpr int kNoTile = -(1 << 23);
  /// Deeper squares of a face cannot be told apart at corners with u = 1 or v = 1: (u, v) are
  /// rounded there to multiples of 2^-53.
  static constexpr int kLargestDepth = 48;

  std::vector<int> child;
  SurfaceTiles tiles;  ///< with one location or more for each tile, in its middle
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> origin;  ///< of each tile on its face
  int levels = 0;  ///< the largest number of splits on the way to a tile
};

/// The tiles of all faces that have a limit surface. What lies closer to an irregular vertex than
/// LimitSurface::tiles() allows for this depth gets the tile beside it.
///
/// Depends on the topology alone, not on the pose. Throws std::invalid_argument for a depth beyond
/// 1 to TileQuadtree::kLargestDepth, otherwise errors as LimitSurface::tiles() does. Cost:
/// O(max_depth) nodes at each irregular vertex, and that of LimitSurface::tiles() for the middles
/// of all tiles.
TileQuadtree tileQuadtree(const LimitSurface& surface, int max_depth = SurfaceTiles::kDefaultDepth,
                          int threads = 0, const Progress& progress = {});

}  // namespace limitsurf
