// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/closest_so_far.h"
#include "limitsurf/search/foot_bound.h"
#include "limitsurf/search/normals/facing.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Improves `best` by the point of the patch that is closest to the searching point or, with
/// `facing`, by its closest foot that meets the condition. The method is branch and bound on the
/// squared distance; Newton's iteration finds the minimum wherever the squared distance is convex.
///
/// `bound` is that of the patch, or knows nothing.
void closestOnPatch(const BezierPatch& patch, const FootBound& bound, const Facing* facing,
                    ClosestSoFar& best);

}  // namespace limitsurf
