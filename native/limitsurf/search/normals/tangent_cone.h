// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/types.h"

namespace limitsurf {

/// The distance counts as falling in a direction if its slope exceeds this. The slope next to a
/// local minimum is the way to the minimum, divided by a length R that is about the radius of the
/// sphere around the searching point. So a place that counts as a minimum is at most
/// kFlatSlope^2 R / 2 = 5e-15 R farther away than the minimum.
constexpr double kFlatSlope = 1e-7;

/// The directions in which a smooth sheet goes on from one of its places: a plane, half a plane
/// where the sheet ends, or the sector between two tangents at its corners.
class TangentCone {
 public:
  /// `ds` and `dt` are the tangents. `s_inwards` is 1 or -1 if the sheet goes on only in this
  /// direction of ds, and 0 if it goes on both ways.
  TangentCone(const Vector3& ds, double s_inwards, const Vector3& dt, double t_inwards);

  /// Whether the distance from a point falls in one of the directions. `offset` leads from the
  /// point to the place; lengths below `tolerance` count as zero.
  bool falls(const Vector3& offset, double tolerance) const;

 private:
  struct Direction {
    Vector3 unit = Vector3::Zero();
    double inwards = 0;
    /// The rounding of `unit`.
    double rounding = 0;
  };

  static Direction along(const Vector3& tangent, double inwards);
  /// The part of a tangent that is perpendicular to another direction.
  static Direction across(const Vector3& tangent, double inwards, const Direction& other);

  Direction first_, second_;
};

}  // namespace limitsurf
