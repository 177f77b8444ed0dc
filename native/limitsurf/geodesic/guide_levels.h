// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/geodesic/geodesic_mesh.h"
#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// How finely the triangles divide each face of the control mesh on which distances from guides are
/// measured, so that the distances are right to kGuideDistanceError: the levels of a GeodesicMesh.
std::vector<int> guideLevels(const LimitSurface& surface, const LocationBatch& guides,
                             const GeodesicCuts& cuts);

}  // namespace limitsurf
