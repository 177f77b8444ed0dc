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
};

/// Locations along curves: curve by curve, and along each curve.
struct AlongCurves {
  std::vector<Location> at;
  std::vector<int> curve;
  std::vector<double> arc;  ///< arc length from the curve's start
  /// Unit vectors in the surface's tangent plane: along the curve, and perpendicular to it, away
  /// from the location's face.
  Points tangent, outward;
};

/// Locations evenly along curves, by true arc length. `curves` must have been made of the surface
/// in its present pose.
///
/// A count is divided among the curves in proportion to their lengths (by largest remainders), and
/// on each curve neighbours are equally far apart; on a closed curve the last one and the first one
/// are, too. A seed gives the same locations on every machine and with any number of threads.
///
/// Throws std::invalid_argument unless exactly one of count and spacing is given, for values out of
/// range, and for a count above 0 on curves without length. Cost: about 1 microsecond a location.
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
