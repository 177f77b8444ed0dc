// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {

// Whether the distance from a point has a local minimum at an extraordinary vertex or next to it,
// among the points of the smooth sheet around it. `way` leads from the vertex to the point, in the
// unit of the tree.
//
// The distances of places on all faces around the vertex decide, at two scales that are small
// compared with the way and with the surface. So vertices of all kinds are treated alike, whether
// they have a normal or not. Cost: O(faces around the vertex). A vertex without a minimum is often
// recognised on the first face.

/// Whether a core is so small that mayHaveMinimumNear() tells of a minimum in it.
bool isNearVertex(const SearchTree& tree, const SurfacePiece& core, const Vector3& way);

/// Whether the distance may have a local minimum at the vertex, or in a core for which
/// isNearVertex() holds. Around such a minimum the distance grows, so that at the larger scale no
/// place is closer than the vertex.
bool mayHaveMinimumNear(const SearchTree& tree, int ring, const Vector3& way);

/// Whether the vertex itself is the minimum if mayHaveMinimumNear() holds: at the smaller scale the
/// distance falls nowhere by a slope of more than kFlatSlope.
bool isFlatAtVertex(const SearchTree& tree, int ring, const Vector3& way);

}  // namespace limitsurf
