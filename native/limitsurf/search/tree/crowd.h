// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// The median of the mesh's vertices, in the unit of the patches, if only outliers make the mesh
/// large. Some of the vertices stand for all. Cost: O(1).
std::optional<Vector3> crowdOf(const LimitSurface& surface, const SurfacePatches& patches);

}  // namespace limitsurf
