// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {

/// How a map (U, V) on the surface shrinks and stretches it, one row per location.
struct MapDistortion {
  Eigen::VectorXd area;          ///< of the surface per area of the map
  Eigen::VectorXd stretch_high;  ///< length on the surface per length on the map: the largest
  Eigen::VectorXd stretch_low;   ///< and the smallest over all directions
};

/// Bound on the relative error of area and stretch_high, and on that of stretch_low times
/// stretch_high / stretch_low; each times how ill-conditioned the map is there: the square of the
/// face's largest derivative over the Jacobian.
constexpr double kDistortionError = 1e-11;

/// Area ratio and singular values of dP/d(U, V), exactly: area = stretch_high * stretch_low, always
/// positive, also where the map is mirrored.
///
/// Where the map is singular (its Jacobian is 0) area and stretch_high are infinite, and
/// stretch_low is NaN; area is NaN where the surface is singular as well. At a vertex where the
/// surface or the map is irregular they are those seen from kSeenFrom inside the face: where both
/// are subdivided by the same rules they have a limit there, which this is close to; else they
/// vanish or diverge.
///
/// Throws as tangentFrames(). Cost: two evaluations a location.
MapDistortion mapDistortion(const LimitSurface& surface, const SurfaceData& uv_map,
                            Span<Location> at, int threads = 0);

}  // namespace limitsurf
