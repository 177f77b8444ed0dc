// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {

/// How a map (U, V) stretches the surface, a row for each location.
struct MapDistortion {
  Eigen::VectorXd area;          ///< area of the surface per area of the map
  Eigen::VectorXd stretch_high;  ///< the largest length on the surface per length on the map
  Eigen::VectorXd stretch_low;   ///< the smallest, over all directions
};

/// Bound on the relative error of area and stretch_high. That of stretch_low may be larger by the
/// factor stretch_high / stretch_low. All are multiplied by the condition of the map: the square of
/// the face's largest derivative divided by the Jacobian determinant. Measured, not derived.
constexpr double kDistortionError = 1e-11;

/// The exact area ratio and singular values of dP/d(U, V), with area = stretch_high * stretch_low.
/// All are positive, also where the map is mirrored.
///
/// Where the map is singular (its Jacobian determinant is 0) area and stretch_high are infinite and
/// stretch_low is NaN; area is NaN where the surface is singular as well. At a vertex where the
/// surface or the map is irregular the values are those kSeenFrom inside the face: they are close
/// to the limit if both are subdivided by the same rules, otherwise the values vanish or diverge
/// there.
///
/// Throws as tangentFrames(). Cost: two evaluations a location.
MapDistortion mapDistortion(const LimitSurface& surface, const SurfaceData& uv_map,
                            const LocationBatch& at, int threads = 0);

}  // namespace limitsurf
