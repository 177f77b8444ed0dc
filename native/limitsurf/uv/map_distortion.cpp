// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/map_distortion.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "limitsurf/batch_parts.h"
#include "limitsurf/surface/map_derivatives.h"

namespace limitsurf {
namespace {

/// The larger singular value of the matrix with these columns.
double largestStretch(const Vector3& x, const Vector3& y) {
  const double scale = std::max(x.cwiseAbs().maxCoeff(), y.cwiseAbs().maxCoeff());
  if (!(scale > 0)) {
    return scale;
  }
  const Vector3 a = x / scale, b = y / scale;
  const double mean = (a.squaredNorm() + b.squaredNorm()) / 2;
  const double half = (a.squaredNorm() - b.squaredNorm()) / 2;
  return scale * std::sqrt(mean + std::hypot(half, a.dot(b)));
}

}  // namespace

MapDistortion mapDistortion(const LimitSurface& surface, const SurfaceData& uv_map,
                            const LocationBatch& at, int threads) {
  checkMap(surface, uv_map, "uv_map");
  const LocationBatch checked = surface.checkLocations(at, threads);
  const auto rows = static_cast<Eigen::Index>(at.size());
  MapDistortion out{Eigen::VectorXd(rows), Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  forEachPart(at.size(), threads, [&](std::size_t begin, std::size_t end) {
    const MapDerivatives d =
        directionalDerivatives(surface, uv_map, checked.rows(begin, end - begin), 1);
    for (Eigen::Index i = 0; i < d.on_map.du.rows(); ++i) {
      const Eigen::Index row = static_cast<Eigen::Index>(begin) + i;
      const double determinant = d.determinant(i);
      const Vector3 du = d.on_surface.du.row(i).transpose(),
                    dv = d.on_surface.dv.row(i).transpose();
      out.area(row) = du.cross(dv).stableNorm() / std::abs(determinant);
      if (determinant == 0) {
        out.stretch_high(row) = std::numeric_limits<double>::infinity();
        out.stretch_low(row) = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      out.stretch_high(row) =
          largestStretch((du * d.on_map.dv(i, 1) - dv * d.on_map.du(i, 1)) / determinant,
                         (dv * d.on_map.du(i, 0) - du * d.on_map.dv(i, 0)) / determinant);
      out.stretch_low(row) = out.stretch_high(row) > 0 ? out.area(row) / out.stretch_high(row) : 0;
    }
  });
  return out;
}

}  // namespace limitsurf
