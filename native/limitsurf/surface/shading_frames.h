// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/types.h"

namespace limitsurf {

/// How renderers read tangent-space normal maps on polygons: frames as they interpolate them from
/// the corners, one row per place. Neither vector is unit or at right angles to the other then, and
/// MikkTSpace's rule is to leave them so.
struct ShadingFrames {
  Points normal, tangent;
  Eigen::VectorXd sign;  ///< of the bitangent
};

/// Bound on the error of each component, times the condition of the frame: the product of the
/// lengths of its three columns over its determinant.
constexpr double kShadingError = 1e-14;

/// The unit vectors (x, y, z) that such a renderer turns into the given directions: that for which
/// x tangent + y sign (normal x tangent) + z normal is along the direction. (0, 0, 1), which is the
/// interpolated normal, where the frame has no volume.
///
/// Throws std::invalid_argument for numbers of rows that differ.
Points intoShadingFrames(const Points& directions, const ShadingFrames& frames);

/// The other way round, as the renderer does it: unit vectors, NaN where they vanish.
Points outOfShadingFrames(const Points& components, const ShadingFrames& frames);

}  // namespace limitsurf
