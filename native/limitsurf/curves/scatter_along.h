// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "limitsurf/curves/edge_curves.h"
#include "limitsurf/progress.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// The locations along curves that are wanted. Exactly one of `count` and `spacing` must be given.
struct AlongOptions {
  std::optional<std::int64_t> count;  ///< on all curves together
  std::optional<double> spacing;      ///< the arc length between neighbours, rounded for each curve
                                      ///< so that it divides the curve's length
  /// By which part of the spacing a location is moved at random, 0 to 1: by half of it at most to
  /// each side. At an open curve's ends locations are reflected.
  double jitter = 0;
  /// Where the first location lies, as a part of the spacing, 0 to 1. By default it is drawn for
  /// each curve.
  std::optional<double> phase;
  std::uint64_t seed = 0;
  CurveSide side = CurveSide::left;  ///< the side whose faces the locations are on, where both have
  /// The number of rows. Row r lies r row distances from the curves, along the surface.
  int rows = 1;
  double row_distance = 0;
};

/// Bound on how much nearer than its row's distance any part of the curves may be to a location,
/// relative to that distance, where the shortest way leads roughly towards the part that is nearest
/// in space. The length of the geodesic from the location's own foot has the error kGeodesicError.
/// Geodesics to the curves are sought in five directions for each part that is nearer in space, and
/// led to the vertex itself where that part is an end or a corner of a curve; this may miss one
/// that leads another way, around a fold.
constexpr double kRowError = 1e-2;

/// Locations along curves: row by row, curve by curve, and along each curve.
struct AlongCurves {
  std::vector<Location> at;
  std::vector<int> curve;
  std::vector<double> arc;  ///< arc length from the curve's start; of the geodesic's foot in rows
  /// Unit vectors in the surface's tangent plane: along the curve, and perpendicular to it, away
  /// from the location's face. In rows the latter points to the foot.
  Points tangent, outward;
  std::vector<int> row;
  std::vector<std::int64_t> ended;  ///< for each row, the number of locations that it lacks
};

/// Locations evenly along curves, by true arc length. `curves` must have been made of the surface
/// in its present pose.
///
/// A count is divided among the curves in proportion to their lengths (by largest remainders), and
/// on each curve neighbours are equally far apart; on a closed curve the last one and the first one
/// are, too. A seed gives the same locations on every machine and with any number of threads.
///
/// The locations of further rows lie at the ends of geodesics that leave the curves
/// perpendicularly, into the faces on the given side, at places that each row draws anew. A row
/// ends where the surface ends, and where it would run into itself or another row: where another
/// part of the curves is nearer than its distance (kRowError).
///
/// Throws std::invalid_argument unless exactly one of count and spacing is given, for values out of
/// range, and for a count above 0 on curves without length. Cost: about 1 microsecond a location
/// on the curves, and some ten microseconds for each in other rows.
AlongCurves scatterAlong(const LimitSurface& surface, const EdgeCurves& curves,
                         const AlongOptions& options, int threads = 0,
                         const Progress& progress = {});

/// The points at arc lengths along curves, one for each pair of a curve's number and an arc length.
/// Throws std::invalid_argument for the first number that is no curve, and for the first arc length
/// that is not between 0 and the curve's length.
AlongCurves pointsAlong(const LimitSurface& surface, const EdgeCurves& curves,
                        const std::vector<std::int64_t>& curve, const std::vector<double>& arc,
                        CurveSide side = CurveSide::left, int threads = 0);

}  // namespace limitsurf
