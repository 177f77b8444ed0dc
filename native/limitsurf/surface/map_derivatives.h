// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/surface_data.h"

namespace limitsurf {

/// Throws std::invalid_argument for a map that does not have two columns or that belongs to a
/// surface with another number of faces. `name` is the argument's name, as in "uv_map".
void checkMap(const LimitSurface& surface, const SurfaceData& map, const char* name);

/// A surface and a map (U, V) on it, evaluated at the same locations.
struct MapDerivatives {
  Evaluation on_surface;  ///< with unit normals
  DataEvaluation on_map;  ///< two columns

  /// The derivatives of (U, V) with respect to u and v, as columns.
  Eigen::Matrix2d jacobian(Eigen::Index row) const {
    Eigen::Matrix2d result;
    result << on_map.du.row(row).transpose(), on_map.dv.row(row).transpose();
    return result;
  }
  /// The determinant of the Jacobian: dU/du dV/dv - dU/dv dV/du.
  double determinant(Eigen::Index row) const {
    return on_map.du(row, 0) * on_map.dv(row, 1) - on_map.dv(row, 0) * on_map.du(row, 1);
  }
};

/// First derivatives of the map, and those of the surface up to `order`, as
/// LimitSurface::evaluate() and SurfaceData::evaluate() give them. Throws what these throw.
MapDerivatives evaluateWithMap(const LimitSurface& surface, const SurfaceData& map,
                               const LocationBatch& at, Derivatives order, int threads);

/// At a vertex where the surface or the map is irregular, or where the first derivatives of one of
/// them vanish, derivatives are taken at this distance inside the face, along its diagonal. On the
/// way to the vertex the derivatives themselves vanish or diverge, while their directions and
/// ratios converge.
constexpr double kSeenFrom = 0x1p-20;

/// First derivatives whose directions and ratios are defined at every location (kSeenFrom says what
/// they are at irregular vertices), with unit normals at the location itself.
/// Throws what checkMap() and LimitSurface::evaluate() throw.
MapDerivatives directionalDerivatives(const LimitSurface& surface, const SurfaceData& uv_map,
                                      const LocationBatch& at, int threads);

}  // namespace limitsurf
