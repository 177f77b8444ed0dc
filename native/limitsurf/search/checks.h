// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

// Checks of arguments. Each throws std::invalid_argument naming the first wrong row or value.

/// The largest coordinate of a point, times the scale of a search, whose square does not overflow.
constexpr double kFarthestPoint = 1e150;

/// Coordinates must be finite and, times `scale`, so small that their squares do not overflow.
/// `name` is what the message calls the array.
void checkFinite(const PointRows& rows, const char* name, double scale = 1);
/// Directions must be finite and not 0.
void checkDirections(const PointRows& rows, const char* name);
/// The distance must be 0 or more, and not NaN.
void checkDistance(double max_distance);
/// The angle, in radians, must be between 0 and pi.
void checkAngle(double max_angle);

}  // namespace limitsurf
