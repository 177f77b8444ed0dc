// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/texel_places.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/number_text.h"
#include "limitsurf/surface/complete_normals.h"
#include "limitsurf/surface/map_derivatives.h"
#include "limitsurf/surface/scaled_tangents.h"

namespace limitsurf {
namespace {

/// Columns are linearly dependent if the sine of their angle is at most this.
constexpr double kSingular = 1e-12;

/// The derivatives of surface and map at locations, and the steps from texel to texel.
struct TexelDerivatives : MapDerivatives {
  ScaledTangents tangents(Eigen::Index row) const {
    return {on_surface.du.row(row), on_surface.dv.row(row)};
  }

  /// Whether surface and map are regular there, and all derivatives that are needed exist.
  bool isRegularAt(Eigen::Index row) const {
    const Evaluation& e = on_surface;
    const ScaledTangents t = tangents(row);
    return isRegular(jacobian(row)) &&
           t.du.cross(t.dv).norm() > kSingular * t.du.norm() * t.dv.norm() &&
           (e.duu.rows() == 0 ||
            (normalBy(e.duu, e.duv, row).allFinite() && normalBy(e.duv, e.dvv, row).allFinite()));
  }

  /// The derivative of the unit normal, given the derivatives of du and dv.
  Vector3 normalBy(const Points& du_by, const Points& dv_by, Eigen::Index row) const {
    const ScaledTangents t = tangents(row);
    const Vector3 across = t.du.cross(t.dv);
    const Vector3 normal = across.normalized();
    const Vector3 change = (t.u_scale * du_by.row(row)).transpose().cross(t.dv) +
                           t.du.cross((t.v_scale * dv_by.row(row)).transpose());
    return (change - normal * normal.dot(change)) / across.norm();
  }

  /// Writes the steps from texel to texel into a row of `places`.
  void put(Eigen::Index from, const Eigen::Vector2d& texel, TexelPlaces& places,
           Eigen::Index row) const {
    if (!isRegular(jacobian(from))) {
      return;
    }
    const Eigen::Matrix2d steps = jacobian(from).inverse() * texel.asDiagonal();
    const auto along = [&](const auto& by_u, const auto& by_v, Points& x, Points& y) {
      if (by_u.allFinite() && by_v.allFinite()) {
        x.row(row) = (by_u * steps(0, 0) + by_v * steps(1, 0)).transpose();
        y.row(row) = (by_u * steps(0, 1) + by_v * steps(1, 1)).transpose();
      }
    };
    places.parameters.row(row) << steps(0, 0), steps(0, 1), steps(1, 0), steps(1, 1);
    const Evaluation& e = on_surface;
    along(e.du.row(from).transpose().eval(), e.dv.row(from).transpose().eval(), places.along_x,
          places.along_y);
    if (e.duu.rows() > 0) {
      along(normalBy(e.duu, e.duv, from), normalBy(e.duv, e.dvv, from), places.normal_along_x,
            places.normal_along_y);
    }
  }
};

}  // namespace

Location steppedAside(const Location& at) {
  return {at.face, at.u + (0.5 - at.u) * kStepAside, at.v + (0.5 - at.v) * kStepAside};
}

bool isRegular(const Eigen::Matrix2d& jacobian) {
  return jacobian.allFinite() && std::abs(jacobian.determinant()) >
                                     kSingular * jacobian.col(0).norm() * jacobian.col(1).norm();
}

Eigen::Matrix2d shortened(const Eigen::Matrix2d& footprint) {
  if (!footprint.allFinite()) {
    return Eigen::Matrix2d::Zero();
  }
  Eigen::Matrix2d result = footprint;
  for (int i = 0; i < 2; ++i) {
    const double length = footprint.col(i).stableNorm();
    if (length > kLongestFootprint) {
      result.col(i) *= kLongestFootprint / length;
    }
  }
  return result;
}

void checkTexel(const Eigen::Vector2d& texel) {
  for (int i = 0; i < 2; ++i) {
    if (!(texel[i] > 0 && std::isfinite(texel[i]))) {
      throw std::invalid_argument("texel has the size " + numberText(texel[i]) +
                                  "; it must be finite and above 0");
    }
  }
}

TexelPlaces texelPlaces(const LimitSurface& surface, const SurfaceData& map,
                        const LocationBatch& at, const Eigen::Vector2d& texel, bool normal_steps,
                        int threads) {
  const auto rows = static_cast<Eigen::Index>(at.size());
  TexelPlaces places;
  for (Points* steps : {&places.along_x, &places.along_y}) {
    steps->setZero(rows, 3);
  }
  for (Points* steps : {&places.normal_along_x, &places.normal_along_y}) {
    steps->setZero(normal_steps ? rows : 0, 3);
  }
  places.parameters.setZero(rows, 4);

  const Derivatives order = normal_steps ? Derivatives::second : Derivatives::first;
  TexelDerivatives here{evaluateWithMap(surface, map, at, order, threads)};
  std::vector<Location> aside;
  std::vector<Eigen::Index> rows_aside;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (here.isRegularAt(row)) {
      here.put(row, texel, places, row);
    } else {
      aside.push_back(steppedAside(at[static_cast<std::size_t>(row)]));
      rows_aside.push_back(row);
    }
  }
  const TexelDerivatives there{evaluateWithMap(surface, map, aside, order, threads)};
  for (std::size_t i = 0; i < rows_aside.size(); ++i) {
    there.put(static_cast<Eigen::Index>(i), texel, places, rows_aside[i]);
  }
  places.position = std::move(here.on_surface.position);
  places.normal = std::move(here.on_surface.normal);
  completeNormals(surface, at, places.normal, threads);
  return places;
}

}  // namespace limitsurf
