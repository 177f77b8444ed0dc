// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tangent_frames.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/map_derivatives.h"

namespace limitsurf {
namespace {

/// v over its largest component, or zero; lengths of the result do not overflow.
template <typename Vector>
Vector scaled(const Vector& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 ? Vector(v / largest) : Vector(Vector::Zero());
}

/// The direction of dP/dU, of any length; zero where there is none.
Vector3 alongU(const MapDerivatives& d, Eigen::Index row, double sign) {
  Eigen::Matrix<double, 3, 2> position;
  position.col(0) = d.on_surface.du.row(row).transpose();
  position.col(1) = d.on_surface.dv.row(row).transpose();
  const Eigen::Vector2d v(d.on_map.du(row, 1), d.on_map.dv(row, 1));
  const Eigen::Matrix<double, 3, 2> p = scaled(position);
  const Eigen::Vector2d w = scaled(v);
  const Vector3 direction = sign * (p.col(0) * w(1) - p.col(1) * w(0));
  const Vector3 normal = d.on_surface.normal.row(row).transpose();
  return scaled(Vector3(direction - direction.dot(normal) * normal));
}

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> tangentFrames(const LimitSurface& surface,
                                                                        const SurfaceData& uv_map,
                                                                        const LocationBatch& at,
                                                                        int threads) {
  const MapDerivatives d = directionalDerivatives(surface, uv_map, at, threads);
  Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> out(at.size(), 9);
  std::vector<std::uint8_t> is_singular(at.size());
  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double determinant = d.determinant(row), sign = determinant < 0 ? -1 : 1;
      const Vector3 tangent = alongU(d, row, sign);
      const Vector3 normal = d.on_surface.normal.row(row).transpose();
      is_singular[i] = !(determinant != 0) || !tangent.allFinite() || tangent.isZero(0);
      if (!is_singular[i]) {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(out.row(row).data());
        frame.col(0) = tangent.normalized();
        frame.col(1) = sign * normal.cross(frame.col(0));
        frame.col(2) = normal;
      }
    }
  });
  std::vector<std::size_t> singular;
  std::vector<Location> places;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (is_singular[i]) {
      singular.push_back(i);
      places.push_back(at[i]);
    }
  }
  const auto frames = surface.frames(places, threads);
  for (std::size_t i = 0; i < singular.size(); ++i) {
    out.row(static_cast<Eigen::Index>(singular[i])) = frames.row(static_cast<Eigen::Index>(i));
  }
  return out;
}

}  // namespace limitsurf
