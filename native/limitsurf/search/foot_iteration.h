// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/parameter_rectangle.h"
#include "limitsurf/search/search_kernels.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

enum class FootSearch {
  arrived,  ///< a minimum was reached
  beyond,   ///< all of the rectangle is so far away that it does not matter
  failed,
};

/// Minimises the distance of a patch from a point over a rectangle of the patch's parameters, by
/// Newton's iteration with an active set of the rectangle's sides. `patch` must have no anchor: its
/// points and `away`, the point, are relative to the same place. The iteration starts and ends at
/// (s, t).
///
/// Where it arrives, the following holds if the squared distance is convex: it is nowhere on the
/// rectangle less by more than `slack`. It ends early if convexity, up to `slack`, shows that the
/// squared distance, less that of `away` itself, is at least `enough` on the whole rectangle.
/// Convexity, or what stands in for it (FootBound), is made use of only within the distance
/// `radius` of the point. `found` becomes the point of the patch at (s, t).
FootSearch minimizeDistance(const SearchKernels& kernels, const BezierPatch& patch,
                            const BezierPatch::Point& away, const ParameterRectangle& on,
                            double slack, double enough, double radius, double& s, double& t,
                            BezierPatch::Point& found);

}  // namespace limitsurf
