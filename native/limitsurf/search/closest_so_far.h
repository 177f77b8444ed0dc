// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The point of a search, as a place near the surface and the way from there to the point.
///
/// For points near the surface the place is the point itself. For points farther away than
/// kFarAway diagonals it is the middle of the surface: differences of distances from far away would
/// drown in the rounding of the distances, so that searches compare squared distances less the
/// square of `range`, which need not be formed as differences.
struct SearchPoint {
  SearchPoint() = default;
  SearchPoint(const Vector3& point, const Vector3& middle, double diagonal);

  Vector3 place = Vector3::Zero();
  Vector3 away = Vector3::Zero();  ///< from the place to the point
  double range = 0;                ///< the length of `away`

  bool isFar() const { return range > 0; }
  BezierPatch::Point paddedAway() const { return {away[0], away[1], away[2], 0}; }

  static constexpr double kFarAway = 16;
  /// From points farther away the surface looks the same: they are moved this near, in diagonals.
  static constexpr double kFarthest = 0x1p60;
};

/// The closest point that a search has found so far.
struct ClosestSoFar {
  SearchPoint from;
  /// Its distance less the range of the searching point.
  double excess = std::numeric_limits<double>::infinity();
  Location at;
  /// It, less `from.place`.
  Vector3 offset = Vector3::Zero();
  /// The surface matters only before a plane through the found point, perpendicular to `direction`,
  /// which leads there from the searching point: that at the distance `plane` from `from.place`.
  Vector3 direction = Vector3::Zero();
  double plane = std::numeric_limits<double>::infinity();

  /// The number of parts of patches that the search has looked at.
  std::int64_t cells = 0;

  /// Points that are closer by less than this are not searched for: a tenth of kSearchError.
  double tolerance = 0;

  /// A part of the surface may be left out if its squared distance, less the square of the range,
  /// is at least this.
  double enough() const {
    const double least = excess - tolerance;
    return least + from.range > 0 ? least * (least + 2 * from.range)
                                  : -std::numeric_limits<double>::infinity();
  }
  /// Takes the point at `where` if it is closer. `place` is relative to `from.place`.
  void offer(const Vector3& place, const Location& where) {
    const Vector3 way = place - from.away;
    const double distance = way.norm();
    const double found =
        from.isFar() ? place.dot(way - from.away) / (distance + from.range) : distance;
    if (found < excess) {
      excess = found;
      at = where;
      offset = place;
      direction = distance > 0 ? Vector3(way / distance) : Vector3::Zero();
      // direction . place = found + (range + direction . away), where direction . away is nearly
      // -range: the sum in brackets is (range found + place . away) / distance.
      plane =
          from.isFar() ? found + (from.range * found + place.dot(from.away)) / distance : distance;
    }
  }
};

}  // namespace limitsurf
