// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// Makes every normal a unit vector. evaluate() leaves a normal NaN where the surface has none,
/// exactly at some irregular vertices; those rows get the third column of LimitSurface::frames() at
/// their location. `normal` has one row per location. Cost: O(rows), and frames() for the rows that
/// are replaced.
void completeNormals(const LimitSurface& surface, const LocationBatch& at,
                     Eigen::Ref<Points> normal, int threads = 0);

}  // namespace limitsurf
