// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/geodesic/surface_triangles.h"
#include "limitsurf/search/polylines.h"

namespace limitsurf {

/// Cuts triangles along curves, so that no way crosses these.
///
/// The curves are laid onto the surface: points on them, at most half a triangle's side apart (of
/// triangles thinner than 1 : 64, a sixteenth of their length), are replaced by the closest ones of
/// the surface, between which the plane section along the normal is taken. Triangles that a curve
/// passes through are divided along it. What divides them lies in their planes, so that all
/// distances but those across the curves remain. A curve whose end is closer to a border or another
/// curve than kReach of a triangle's height ends there.
///
/// `levels` are those with which the triangles were made. Parts of curves that no section joins
/// along the surface, as on the way from one lip to the other, leave a gap in the cut.
void cutAlongCurves(SurfaceTriangles& triangles, const LimitSurface& surface,
                    const std::vector<int>& levels, const Polylines& curves, int threads);

}  // namespace limitsurf
