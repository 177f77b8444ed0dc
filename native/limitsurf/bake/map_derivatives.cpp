// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/bake/map_derivatives.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace limitsurf {
namespace {

void checkMap(const LimitSurface& surface, const SurfaceData& uv_map) {
  if (uv_map.columns() != 2) {
    throw std::invalid_argument("uv_map has " + std::to_string(uv_map.columns()) +
                                " columns; expected 2");
  }
  if (uv_map.faceCount() != surface.faceCount()) {
    throw std::invalid_argument("uv_map is of a surface with " +
                                std::to_string(uv_map.faceCount()) + " Ptex faces; this one has " +
                                std::to_string(surface.faceCount()));
  }
}

bool isCorner(const Location& at) { return (at.u == 0 || at.u == 1) && (at.v == 0 || at.v == 1); }

/// Whether directions cannot be told from the derivatives there.
bool isFlat(const MapDerivatives& d, Eigen::Index row) {
  const Vector3 across = d.du.row(row).cross(d.dv.row(row)).transpose();
  const double determinant = d.determinant(row);
  return !across.allFinite() || !std::isfinite(determinant) || across.isZero(0) || determinant == 0;
}

Location inside(Location at) {
  at.u += at.u == 0 ? kSeenFrom : -kSeenFrom;
  at.v += at.v == 0 ? kSeenFrom : -kSeenFrom;
  return at;
}

}  // namespace

MapDerivatives mapDerivatives(const LimitSurface& surface, const SurfaceData& uv_map,
                              Span<Location> at, int threads) {
  checkMap(surface, uv_map);
  Evaluation position = surface.evaluate(at, Derivatives::first, true, threads);
  DataEvaluation map = uv_map.evaluate(at, Derivatives::first, threads);
  MapDerivatives out{std::move(position.du), std::move(position.dv), std::move(position.normal),
                     std::move(map.du), std::move(map.dv)};

  std::vector<std::size_t> flat, without_normal;
  std::vector<Location> seen_from, exactly;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (isCorner(at[i]) && isFlat(out, row)) {
      flat.push_back(i);
      seen_from.push_back(inside(at[i]));
    }
    if (!out.normal.row(row).allFinite()) {
      without_normal.push_back(i);
      exactly.push_back(at[i]);
    }
  }
  if (!flat.empty()) {
    const Evaluation nearby = surface.evaluate(seen_from, Derivatives::first, false, threads);
    const DataEvaluation nearby_map = uv_map.evaluate(seen_from, Derivatives::first, threads);
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(flat[i]), from = static_cast<Eigen::Index>(i);
      out.du.row(row) = nearby.du.row(from);
      out.dv.row(row) = nearby.dv.row(from);
      out.map_du.row(row) = nearby_map.du.row(from);
      out.map_dv.row(row) = nearby_map.dv.row(from);
    }
  }
  if (!without_normal.empty()) {
    const auto frames = surface.frames(exactly, threads);
    for (std::size_t i = 0; i < without_normal.size(); ++i) {
      const auto from = static_cast<Eigen::Index>(i);
      out.normal.row(static_cast<Eigen::Index>(without_normal[i])) << frames(from, 2),
          frames(from, 5), frames(from, 8);
    }
  }
  return out;
}

}  // namespace limitsurf
