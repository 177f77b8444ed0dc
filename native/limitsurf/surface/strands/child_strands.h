// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/progress.h"
#include "limitsurf/surface/strands/strand_poser.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Polylines through points, resampled: `count` points each, at equal distances along the polyline.
/// Strand i has the points offsets[i] to offsets[i + 1] - 1 and at least one. Its first and its
/// last point stay where they are. Throws std::invalid_argument for a count below 2, and for
/// offsets that do not begin with 0, end at another number than that of the points, or do not
/// increase.
Points resampledStrands(const Points& points, const std::vector<std::int64_t>& offsets, int count,
                        int threads = 0);

/// The guides of children: all have the same number of points, one guide after the other.
struct GuideStrands {
  Points points;
  Points normals;  ///< of the surface at the guides' roots: one unit vector for each guide
  int points_per_strand = 2;
};

/// The children of guides: where they stand, and which guides they follow.
struct ChildRoots {
  Points position;
  Points normal;                    ///< unit vectors
  std::vector<std::int32_t> guide;  ///< `guides` in each row; -1 with the weight 0 where one lacks
  std::vector<double> weight;
  int guides = 4;
};

/// Strands that are shaped as the guides around them. The shape of a guide, relative to its first
/// point, is turned by the smallest rotation that turns the surface's normal at the guide's root
/// into that at the child's, which on a sphere is parallel transport along the great circle. The
/// child's shape is the weighted mean of these, scaled about the root so that its length is the
/// weighted mean of their lengths. Its first point is exactly the child's position, rounded to
/// float.
///
/// Throws std::invalid_argument for other numbers of rows, and naming the first row with a guide
/// that does not exist. Cost: some nanoseconds for each point and guide.
FloatPoints childStrands(const GuideStrands& guides, const ChildRoots& children, int threads = 0,
                         const Progress& progress = {});

}  // namespace limitsurf
