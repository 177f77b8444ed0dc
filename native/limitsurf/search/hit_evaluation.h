// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/surface_search.h"

namespace limitsurf {

/// Sets the position and the normal of hits at their locations, and all NaN where the face is -1.
/// Gives distances their number, and leaves their values to the caller.
void completeHits(const LimitSurface& surface, Hits& hits, int threads);

}  // namespace limitsurf
