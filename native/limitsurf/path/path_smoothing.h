// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

/// A path whose points lie on the surface.
struct PathPoints {
  std::vector<Location> at;
  Points position;
};

/// Smooths a path on the surface. In each iteration every point moves, by half its weight (0 to 1),
/// towards the place between its neighbours that divides their distance as the point did at the
/// beginning, and from there to the closest point of the surface. Straightest paths are what it
/// converges to; on a straight path nothing moves. The ends of an open path stay; a closed path
/// repeats its first point as its last, and these move together.
///
/// Points move by at most half the distance of their neighbours in an iteration, so a path stays on
/// its side of a sheet that is thicker than that. Cost: one search for each point and iteration.
///
/// Throws LocationError for locations that are not on the surface, and std::invalid_argument for
/// weights outside [0, 1], another number of weights, and fewer than 0 iterations.
PathPoints smoothPath(const LimitSurface& surface, const SurfaceSearch& search,
                      const std::vector<Location>& path, const Eigen::VectorXd& weights,
                      int iterations, bool closed, int threads = 0);

/// The largest number of points of an even path.
constexpr int kMostPathPoints = 10'000'000;

/// `count` points of the surface, closest to the places that divide the polyline through the path's
/// points into parts of equal length. The first and the last are those of the path.
///
/// Throws as smoothPath() does, and std::invalid_argument for a count below 2 or
/// above kMostPathPoints.
PathPoints evenPath(const LimitSurface& surface, const SurfaceSearch& search,
                    const std::vector<Location>& path, int count, int threads = 0);

}  // namespace limitsurf
