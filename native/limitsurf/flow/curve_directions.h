// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/progress.h"
#include "limitsurf/search/polylines.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The number of polygons on which curveDirections() computes, to a factor of 2, unless the mesh
/// itself has more or they would be smaller than 1/64 of a face.
constexpr std::int64_t kFlowPolygons = 30000;

/// Unit tangents of the surface that continue the directions of curves smoothly over it, one row
/// for each location; 0 where no way along the surface leads to a curve.
///
/// At a curve the direction is the curve's own (from its first point to its last), seen from the
/// surface's point that is closest to it. Elsewhere it is the field of tangent vectors that changes
/// least: the one with the smallest integral of |grad X|^2 over the surface among those that agree
/// with the curves, made unit vectors. So a place follows the curves that are near it along the
/// surface, between two curves the direction turns from one to the other, and the field does not
/// pass from one lip to the other. Vectors are compared by turning one tangent plane into the other
/// (parallel transport; Sharp, Soliman, Crane: "The vector heat method", 2019, from which the
/// discretisation differs: tangent planes are turned by rotations in space, which needs no
/// orientation, and the energy is that of linear functions on triangles, never negative).
///
/// The field is computed on kFlowPolygons polygons of a uniform tessellation. Curves that cross one
/// polygon in different directions are averaged there.
///
/// Properties:
///   (1) a straight curve on a flat surface gives its own direction everywhere;
///   (2) between two parallel lines across a flat strip the vectors change linearly;
///   (3) any number of threads gives the same bits, and a row does not depend on the others.
///
/// Throws what LimitSurface::evaluate() throws, and std::invalid_argument for offsets that do not
/// begin with 0, decrease, or do not end with the number of points; naming the first point that is
/// not finite; for curves of more than 30 million pieces as long as half a polygon's side; and if
/// no part of a curve runs along the surface. Cost, on one core: 0.35 s for 16,000 polygons and 3.5
/// s for 100,000; 0.3 microseconds a row.
Points curveDirections(const LimitSurface& surface, const Polylines& curves,
                       const LocationBatch& at, int threads = 0, const Progress& progress = {});

}  // namespace limitsurf
