// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The distance counts as falling in a direction if its slope exceeds this. The slope next to a
/// local minimum is the way to the minimum, divided by a length R that is about the radius of the
/// sphere around the searching point. So a place that counts as a minimum is at most
/// kFlatSlope^2 R / 2 = 5e-15 R farther away than the minimum.
constexpr double kFlatSlope = 1e-7;

/// A place of a smooth sheet.
struct SheetPlace {
  BezierPatch::Values at;  ///< with second derivatives
  /// 1 or -1 if the sheet goes on only in this direction of ds, or of dt; 0 if it goes on both
  /// ways.
  double s_inwards = 0, t_inwards = 0;
};

/// Whether the distance from a point has a local minimum at a place, among the points of the sheet:
/// it falls in none of the directions in which the sheet goes on, and where it neither falls nor
/// rises it does not begin to fall. `offset` leads from the point to the place.
///
/// `tolerance` is 1e-13 of the diagonal of the control mesh: shorter lengths count as zero, and
/// second derivatives have a rounding of a part of it. On patches smaller than 1e-6 of the diagonal
/// only the slopes decide.
bool isLocalMinimum(const SheetPlace& place, const Vector3& offset, double tolerance);

}  // namespace limitsurf
