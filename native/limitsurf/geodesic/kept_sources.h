// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/geodesic/geodesic_mesh.h"
#include "limitsurf/geodesic/nearest_sources.h"

namespace limitsurf {

/// The most sources that a vertex keeps because its triangles are long.
constexpr int kMostKept = 256;

/// How many of its nearest sources each vertex keeps, so that the places on its triangles learn of
/// their own `count` nearest ones.
///
/// Mostly these are `count` and a few `spare` ones. But where triangles are longer than the
/// distance between sources, as at the tip of a pole, the sources that are nearest to one end of a
/// triangle are not those that are nearest to its other end. A vertex with sides up to L, whose
/// last wanted source is d away, needs all sources within d + 2 L. So do the vertices on the ways
/// from these to it, within as much less as they are nearer to them. This is done where triangles
/// are six times as long as wide, or their sides twice as long as on average; kMostKept sources
/// are the most.
std::vector<int> keptSources(const GeodesicMesh& mesh, const std::vector<MeshPlace>& sources,
                             int count, int spare);

}  // namespace limitsurf
