// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/parameter_square.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Minimises the distance of a patch from the origin over a square of the patch's parameters, by
/// Newton's iteration with an active set of the square's sides. `patch` must have no anchor: its
/// points are relative to the origin. The iteration starts and ends at (s, t).
///
/// Returns whether a minimum was reached: if the squared distance is convex, then it is nowhere on
/// the square less by more than `slack`.
bool minimizeDistance(const BezierPatch& patch, const ParameterSquare& square, double slack,
                      double& s, double& t);

}  // namespace limitsurf
