// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/project/projection.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/search/checks.h"
#include "limitsurf/surface/map_derivatives.h"
#include "limitsurf/surface/scaled_tangents.h"
#include "limitsurf/uv/texel_places.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The maps of points and normals from the surface's space to the source's and to world space.
struct Spaces {
  explicit Spaces(const NormalProjectOptions& options)
      : points(options.transform.topRows<3>()),
        vectors(invertibleLinearPart(options.transform, "transform")) {
    const Eigen::Matrix3d world = invertibleLinearPart(options.world, "world");
    world_normals = world.inverse().transpose();
    normals = vectors * (world.transpose() * world).inverse();
  }

  Vector3 point(const Vector3& p) const { return points.leftCols<3>() * p + points.col(3); }

  Eigen::Matrix<double, 3, 4> points;  ///< to the source's space
  Eigen::Matrix3d vectors;
  Eigen::Matrix3d normals;  ///< from a normal to the vector that is perpendicular in the world
  Eigen::Matrix3d world_normals;  ///< the same to world space, where lengths are measured
};

/// The first hit of each texel's ray on the source. `along` is its distance, in lengths of the
/// ray's direction, negative against the normal.
struct Meetings {
  std::vector<Location> at;
  Eigen::VectorXd along;
};

/// The rays of all texels along the normals.
class NormalRays {
 public:
  NormalRays(const TexelPlaces& places, const Spaces& spaces, const NormalProjectOptions& options)
      : origins_(places.position.rows(), 3), directions_(places.position.rows(), 3) {
    longest_.resize(places.position.rows());
    for (Eigen::Index row = 0; row < origins_.rows(); ++row) {
      const Vector3 normal = places.normal.row(row);
      origins_.row(row) = spaces.point(places.position.row(row));
      directions_.row(row) = spaces.normals * normal;
      longest_[row] = options.max_distance / (spaces.world_normals * normal).norm();
    }
  }

  const Points& directions() const { return directions_; }

  /// The nearest hits along the normals, against them, or in both directions.
  Meetings meet(const SurfaceSearch& source, RayDirection which, int threads) const {
    Meetings found;
    found.at.resize(static_cast<std::size_t>(origins_.rows()));
    found.along.setConstant(origins_.rows(), kInfinity);
    if (which != RayDirection::inward) {
      keepNearer(source, 1, found, threads);
    }
    if (which != RayDirection::outward) {
      keepNearer(source, -1, found, threads);
    }
    return found;
  }

 private:
  /// Replaces hits by those in one direction that are nearer.
  void keepNearer(const SurfaceSearch& source, double sign, Meetings& found, int threads) const {
    const Eigen::VectorXd lengths = directions_.rowwise().norm();
    const double farthest =
        origins_.rows() > 0 ? (longest_.array() * lengths.array()).maxCoeff() : 0;
    const Hits hits = source.rayCast(origins_, sign * directions_, farthest, threads);
    for (Eigen::Index row = 0; row < origins_.rows(); ++row) {
      const Location& at = hits.at[static_cast<std::size_t>(row)];
      const double along = hits.distance[row] / lengths[row];
      if (at.face >= 0 && along <= longest_[row] && along < std::abs(found.along[row])) {
        found.at[static_cast<std::size_t>(row)] = at;
        found.along[row] = sign * along;
      }
    }
  }

  Points origins_, directions_;
  Eigen::VectorXd longest_;  ///< the largest distance, in lengths of the direction
};

/// The first derivatives of the source and its map at locations.
struct SourcePlaces {
  SourcePlaces(const LimitSurface& source, const SurfaceData& map, const LocationBatch& at,
               int threads)
      : on_source(source.evaluate(at, Derivatives::first, false, threads)),
        on_map(map.evaluate(at, Derivatives::first, threads)) {}

  /// The steps of the map when the origin of a ray along `direction` moves by the columns of
  /// `steps`. They are not finite where the ray is tangent to the source or the source is singular.
  Eigen::Matrix2d mapSteps(Eigen::Index row, const Vector3& direction,
                           const Eigen::Matrix<double, 3, 2>& steps) const {
    const ScaledTangents t(on_source.du.row(row), on_source.dv.row(row));
    const Vector3 across = t.du.cross(t.dv);
    const Eigen::Matrix<double, 3, 2> in_plane =
        steps - direction * (across.transpose() * steps) / across.dot(direction);
    // Solves du a + dv b = step for a step in the tangent plane.
    const double square = across.squaredNorm();
    Eigen::Matrix2d parameters, map;
    parameters.row(0) = t.u_scale * (t.dv.cross(across).transpose() * in_plane / square);
    parameters.row(1) = t.v_scale * (across.cross(t.du).transpose() * in_plane / square);
    map << on_map.du.row(row).transpose(), on_map.dv.row(row).transpose();
    return map * parameters;
  }

  Evaluation on_source;
  DataEvaluation on_map;
};

}  // namespace

void checkProjectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                              const LimitSurface& source, const SurfaceData& source_map,
                              const Eigen::Vector2d& texel, const NormalProjectOptions& options) {
  checkMap(surface, map, "uv_map");
  checkMap(source, source_map, "source_map");
  checkTexel(texel);
  checkDistance(options.max_distance);
  invertibleLinearPart(options.transform, "transform");
  invertibleLinearPart(options.world, "world");
}

Projection projectAlongNormals(const LimitSurface& surface, const SurfaceData& map,
                               const LocationBatch& at, const LimitSurface& source,
                               const SurfaceData& source_map, const SurfaceSearch& source_search,
                               const Eigen::Vector2d& texel, const NormalProjectOptions& options,
                               int threads) {
  checkThreads(threads);
  checkProjectAlongNormals(surface, map, source, source_map, texel, options);
  const Spaces spaces(options);
  const TexelPlaces places = texelPlaces(surface, map, at, texel, true, threads);
  const NormalRays rays(places, spaces, options);
  const Meetings found = rays.meet(source_search, options.direction, threads);

  std::vector<Location> met, aside;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (found.at[i].face >= 0) {
      met.push_back(found.at[i]);
      aside.push_back(steppedAside(found.at[i]));
      rows.push_back(static_cast<Eigen::Index>(i));
    }
  }
  const SourcePlaces here(source, source_map, met, threads);
  const auto steps = [&](Eigen::Index row) {
    Eigen::Matrix<double, 3, 2> result;
    const auto step = [&](const Points& place, const Points& normal) {
      return (spaces.vectors * place.row(row).transpose() +
              found.along[row] * (spaces.normals * normal.row(row).transpose()))
          .eval();
    };
    result << step(places.along_x, places.normal_along_x),
        step(places.along_y, places.normal_along_y);
    return result;
  };

  const auto count = static_cast<Eigen::Index>(at.size());
  Projection result;
  result.st.setConstant(count, 2, kNaN);
  result.footprint.setZero(count, 4);
  result.weight.setZero(count);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Index row = rows[i], hit = static_cast<Eigen::Index>(i);
    const Vector3 direction = rays.directions().row(row);
    Eigen::Matrix2d footprint = here.mapSteps(hit, direction, steps(row));
    if (!footprint.allFinite()) {
      footprint =
          SourcePlaces(source, source_map, {&aside[i], 1}, 1).mapSteps(0, direction, steps(row));
    }
    footprint = shortened(footprint);
    result.st.row(row) = here.on_map.value.row(hit);
    result.footprint.row(row) << footprint(0, 0), footprint(0, 1), footprint(1, 0), footprint(1, 1);
    result.weight[row] = 1;
  }
  return result;
}

}  // namespace limitsurf
