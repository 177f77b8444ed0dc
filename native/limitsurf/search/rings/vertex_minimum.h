// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/search_tree.h"

namespace limitsurf {

/// Whether the distance from a point has a local minimum at an extraordinary vertex, among the
/// points of the smooth sheet around it. `way` leads from the vertex to the point, in the unit of
/// the tree.
///
/// The distances of places on all faces around the vertex decide, at two scales that are small
/// compared with the way and with the surface. So vertices of all kinds are treated alike, whether
/// they have a normal or not. A vertex counts as a minimum if the distance falls nowhere by a slope
/// of more than kFlatSlope.
///
/// Cost: O(faces around the vertex). A vertex that is no minimum is often recognised on the first
/// face.
bool isMinimumAtVertex(const SearchTree& tree, int ring, const Vector3& way);

/// Whether a core is so small that mayHaveMinimumNear() tells of a minimum in it.
bool isNearVertex(const SearchTree& tree, const SurfacePiece& core, const Vector3& way);

/// Whether the distance may have a local minimum in a core for which isNearVertex() holds. Around
/// such a minimum the distance grows, so that at a scale that is many times as large as the core no
/// place is closer than the vertex. Cost: as above.
bool mayHaveMinimumNear(const SearchTree& tree, int ring, const Vector3& way);

}  // namespace limitsurf
