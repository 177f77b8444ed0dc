// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limitsurf/geodesic/shortest_ways.h"
#include "limitsurf/path/laid_path.h"

namespace limitsurf {

/// Segments of a path between two places of the surface.
struct JoinedGap {
  std::vector<Location> at;  ///< between the segments: one fewer than there are
  std::vector<Vector3> position;
  std::vector<double> deviation;  ///< of each segment from the surface
};

/// Joins the ends of gaps in paths by short ways along the surface.
class GapJoiner {
 public:
  GapJoiner(const LimitSurface& surface, const SurfaceSearch& search, const LayOptions& options)
      : surface_(surface), search_(search), options_(options) {}

  /// Joins two places, if there is a way that is not longer than kLongestWay times their distance
  /// in space. Its segments keep the tolerance and the step of the options.
  std::optional<JoinedGap> join(const Location& from, const Location& to);

 private:
  const LimitSurface& surface_;
  const SurfaceSearch& search_;
  const LayOptions& options_;
  std::optional<ShortestWays> ways_;  // made when the first gap is joined
};

}  // namespace limitsurf
