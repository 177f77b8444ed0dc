// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {

/// First derivatives of a surface and of a map on it at the same locations.
struct MapDerivatives {
  Points du, dv;            ///< of the position
  Points normal;            ///< unit, that of the location itself
  DataRows map_du, map_dv;  ///< of (U, V), two columns

  /// dU/du dV/dv - dU/dv dV/du.
  double determinant(Eigen::Index row) const {
    return map_du(row, 0) * map_dv(row, 1) - map_dv(row, 0) * map_du(row, 1);
  }
};

/// At a vertex where the surface or the map is irregular, or one of them is flat to first order,
/// derivatives are those seen from so far inside the face, along its diagonal: directions and
/// ratios converge on the way to the vertex, while the derivatives themselves vanish or diverge.
constexpr double kSeenFrom = 0x1p-20;

/// Derivatives for at[begin..end). Throws as LimitSurface::evaluate(), and std::invalid_argument
/// for a map that has not two columns or belongs to a surface with another number of faces.
MapDerivatives mapDerivatives(const LimitSurface& surface, const SurfaceData& uv_map,
                              Span<Location> at, int threads);

}  // namespace limitsurf
