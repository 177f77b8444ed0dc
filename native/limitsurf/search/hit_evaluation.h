// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

/// Hits with the position and the normal at the locations, NaN where the face is -1. The caller
/// sets the distances.
Hits hitsAt(const LimitSurface& surface, std::vector<Location> at, int threads);

}  // namespace limitsurf
