// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

/// Throw std::invalid_argument that quotes what is wrong and in which row.
/// Finite, and not so far away that squares overflow. `name`: of one row, as in "point".
void checkFinite(const Points& rows, const char* name);
void checkDirections(const Points& rows);
void checkRows(const Points& rows, Eigen::Index expected, const char* name);
/// Not NaN and not negative.
void checkDistance(double max_distance);
/// Between 0 and pi.
void checkAngle(double max_angle);

/// Position and normal at the locations, NaN where the face is -1; distances are left to the
/// caller.
Hits hitsAt(const LimitSurface& surface, std::vector<Location> at, int threads);

}  // namespace limitsurf
