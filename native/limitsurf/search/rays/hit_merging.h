// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/rays/patch_intersection.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Sorts the hits of a ray and keeps one of several that are the same: each of two neighbouring
/// patches finds a hit on their common border, and several cells of a patch may find the same
/// touching point. `tolerance` is that of the search. Cost: O(n log n) for n hits, and more where
/// many of them are nearly the same.
void mergeHits(const LimitSurface& surface, double tolerance, std::vector<RayHit>& hits);

}  // namespace limitsurf
