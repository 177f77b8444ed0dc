// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tangent_frames.h"

#include <Eigen/Geometry>
#include <vector>

#include "limitsurf/batch_parts.h"
#include "limitsurf/large_pages.h"
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

/// The frames of some locations, into the rows of `out`.
void setTangentFrames(const LimitSurface& surface, const SurfaceData& uv_map,
                      const LocationBatch& at, Eigen::Ref<TangentFrames> out) {
  const MapDerivatives d = directionalDerivatives(surface, uv_map, at, 1);
  std::vector<Eigen::Index> singular;
  std::vector<Location> places;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    const double determinant = d.determinant(row), sign = determinant < 0 ? -1 : 1;
    const Vector3 tangent = alongU(d, row, sign);
    if (!(determinant != 0) || !tangent.allFinite() || tangent.isZero(0)) {
      singular.push_back(row);
      places.push_back(at[static_cast<std::size_t>(row)]);
      continue;
    }
    const Vector3 normal = d.on_surface.normal.row(row).transpose();
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(out.row(row).data());
    frame.col(0) = tangent.normalized();
    frame.col(1) = sign * normal.cross(frame.col(0));
    frame.col(2) = normal;
  }
  const auto frames = surface.frames(places, 1);
  for (std::size_t i = 0; i < singular.size(); ++i) {
    out.row(singular[i]) = frames.row(static_cast<Eigen::Index>(i));
  }
}

}  // namespace

TangentFrames tangentFrames(const LimitSurface& surface, const SurfaceData& uv_map,
                            const LocationBatch& at, int threads) {
  checkMap(surface, uv_map, "uv_map");
  const LocationBatch checked = surface.checkLocations(at, threads);
  TangentFrames out;
  resizeRows(out, at.size());
  forEachPart(at.size(), threads, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    setTangentFrames(
        surface, uv_map, checked.rows(begin, count),
        out.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(count)));
  });
  return out;
}

}  // namespace limitsurf
