// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/parameter_square.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Newton's iteration for the least distance of a patch from the origin, within a square of its
/// parameters, by an active set of the square's sides. `patch` has no anchor: its points are
/// relative to the origin.
///
/// Whether it arrived at a point where no direction leads down, or none so far that the squared
/// distance, if it is convex, could fall by more than `slack`.
bool minimizeDistance(const BezierPatch& patch, const ParameterSquare& square, double slack,
                      double& s, double& t);

}  // namespace limitsurf
