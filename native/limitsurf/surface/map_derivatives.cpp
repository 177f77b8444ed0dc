// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/map_derivatives.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/surface/complete_normals.h"
#include "limitsurf/surface/face_corner.h"

namespace limitsurf {
namespace {

/// Whether the derivatives there define no directions.
bool isFlat(const MapDerivatives& d, Eigen::Index row) {
  const Evaluation& e = d.on_surface;
  const Vector3 across = e.du.row(row).cross(e.dv.row(row)).transpose();
  const double determinant = d.determinant(row);
  return !across.allFinite() || !std::isfinite(determinant) || across.isZero(0) || determinant == 0;
}

Location inside(Location at) {
  at.u += at.u == 0 ? kSeenFrom : -kSeenFrom;
  at.v += at.v == 0 ? kSeenFrom : -kSeenFrom;
  return at;
}

}  // namespace

void checkMap(const LimitSurface& surface, const SurfaceData& map, const char* name) {
  if (map.columns() != 2) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(map.columns()) +
                                " columns; expected 2");
  }
  if (map.faceCount() != surface.faceCount()) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(map.faceCount()) +
                                " Ptex faces and the surface " +
                                std::to_string(surface.faceCount()));
  }
}

MapDerivatives evaluateWithMap(const LimitSurface& surface, const SurfaceData& map,
                               const LocationBatch& at, Derivatives order, int threads) {
  const LocationBatch checked = surface.checkLocations(at, threads);
  return {surface.evaluate(checked, order, true, threads),
          map.evaluate(checked, Derivatives::first, threads)};
}

MapDerivatives directionalDerivatives(const LimitSurface& surface, const SurfaceData& uv_map,
                                      const LocationBatch& at, int threads) {
  checkMap(surface, uv_map, "uv_map");
  MapDerivatives out = evaluateWithMap(surface, uv_map, at, Derivatives::first, threads);
  std::vector<Eigen::Index> flat;
  std::vector<Location> seen_from;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (isCorner(at[i]) && isFlat(out, row)) {
      flat.push_back(row);
      seen_from.push_back(inside(at[i]));
    }
  }
  if (!flat.empty()) {
    const MapDerivatives nearby =
        evaluateWithMap(surface, uv_map, seen_from, Derivatives::first, threads);
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const auto from = static_cast<Eigen::Index>(i);
      out.on_surface.du.row(flat[i]) = nearby.on_surface.du.row(from);
      out.on_surface.dv.row(flat[i]) = nearby.on_surface.dv.row(from);
      out.on_map.du.row(flat[i]) = nearby.on_map.du.row(from);
      out.on_map.dv.row(flat[i]) = nearby.on_map.dv.row(from);
    }
  }
  completeNormals(surface, at, out.on_surface.normal, threads);
  return out;
}

}  // namespace limitsurf
