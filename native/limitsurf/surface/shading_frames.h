// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/types.h"

namespace limitsurf {

/// The frames in which renderers read tangent-space normal maps on polygons, one row per place.
/// They are interpolated from the corners of the polygons, so that their vectors are neither of
/// unit length nor perpendicular to each other, and MikkTSpace's rule is not to change that.
struct ShadingFrames {
  Points normal, tangent;
  Eigen::VectorXd sign;  ///< of the bitangent
};

/// Bound on the error of each component, relative to the condition of the frame: the product of the
/// lengths of its three columns over the size of its determinant. Derivation: docs/accuracy.md.
constexpr double kShadingError = 1e-14;

/// The unit vectors (x, y, z) from which such a renderer gets the given directions: those for which
/// x tangent + y sign (normal x tangent) + z normal has the direction. Where the frame's
/// determinant is 0 they are (0, 0, 1), which is the interpolated normal.
///
/// Throws std::invalid_argument if the numbers of rows differ.
Points intoShadingFrames(const Points& directions, const ShadingFrames& frames);

/// The inverse, as the renderer computes it: unit vectors, or NaN where they vanish.
Points outOfShadingFrames(const Points& components, const ShadingFrames& frames);

}  // namespace limitsurf
