// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// Whether the squared distance of a bicubic patch from a point is certain to be a convex function
/// of (s, t) on the whole patch. `points` are the patch's Bezier points and `away` the point, both
/// relative to the same place.
///
/// The test bounds the Hessian P_s P_s + (P - q) P_ss, and so on, by the hulls of the differences
/// of the control points. It says no too often, but costs a fifth of what the coefficients of the
/// squared distance cost, by which SquaredDistance decides.
bool isConvexDistance(const BezierPatch::Point points[16], const BezierPatch::Point& away);

}  // namespace limitsurf
