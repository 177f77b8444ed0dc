// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/batch/patch_run.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tiled_surface.h"

namespace limitsurf {

/// Evaluates a pose of the tiles at each location of a batch, by all threads. The results have room
/// for the batch. Throws what LimitSurface::evaluate() throws for locations.
template <typename Real>
void evaluateBatch(const TiledSurface& tiles, const Pose& pose, const LocationBatch& at,
                   Derivatives derivatives, const PatchResults<Real>& results, int threads);

}  // namespace limitsurf
