// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "limitsurf/path/space_curves.h"
#include "limitsurf/search/surface_search.h"

namespace limitsurf {

struct LayOptions {
  /// The largest distance of the path from the surface, and from the exact projection of the curve.
  double tolerance = 0;
  /// The largest distance of two consecutive points of the path.
  double max_step = std::numeric_limits<double>::infinity();
  int threads = 0;
};

/// Polylines whose points lie on the surface. Path p consists of rows offsets[p] to
/// offsets[p + 1] - 1. A curve that could not be laid in one piece has several paths.
struct LaidPaths {
  std::vector<Location> at;
  Points position;
  std::vector<double> place;          ///< on the curve: see SpaceCurves::at()
  std::vector<std::int64_t> offsets;  ///< of the paths' rows
  std::vector<int> curve;             ///< for each path, the curve that it comes from
  /// For each path whether it is closed; then its last row repeats its first.
  std::vector<char> closed;
  /// For each path the largest distance of its segments from the surface that was measured: at most
  /// the tolerance, or 1e-12 times the largest coordinate (largestDistances() says how).
  std::vector<double> deviation;
};

/// How many times as long as a gap in space a way along the surface may be that joins it.
constexpr double kLongestWay = 4;

/// Lays curves onto the limit surface, between their control points too.
///
/// Each point of a curve goes to the closest point of the surface. Between control points the path
/// is refined by halving, until every segment is within the tolerance of the surface, and of the
/// projections of the curve at a quarter, a half and three quarters of the segment.
///
/// Where closest points jump (beyond a concave fold, the curve is equally close to both sides) the
/// path is joined along the surface: the point closest to the middle of the gap halves it again and
/// again. Where that does not narrow the gap, a short way along the surface joins it. Where there
/// is none that is at most kLongestWay times as long as the gap in space, as between the two sides
/// of a thin sheet, the path ends, and another one begins beyond. Where a path leaves a part of the
/// surface and comes back without a control point in between, as past an eye in a head, such a way
/// joins both ends, too, and what lies between is left out.
///
/// The control points themselves are rows of the path, with whole numbers as their places. Depends
/// neither on the number of threads nor on the other curves, to the last bit. Cost: some 40
/// searches for each segment; where short ways are needed, a tessellation of the surface, and for
/// each of them the distances of the triangles that are near enough.
///
/// Throws what SpaceCurves::check() throws, std::invalid_argument for a tolerance or a step that is
/// not above 0 and for paths of more than ten million points, and MeshError for a surface without
/// faces.
LaidPaths layCurves(const LimitSurface& surface, const SurfaceSearch& search,
                    const SpaceCurves& curves, const LayOptions& options);

}  // namespace limitsurf
