// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/direction_maps.h"
#include "limitsurf/number_text.h"
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

std::string rowText(const Vector3& v) {
  return "(" + numberText(v[0]) + ", " + numberText(v[1]) + ", " + numberText(v[2]) + ")";
}

/// The maps of points and normals from the surface's space to the source's and to world space.
///
/// With the matrices W to world space and T to the source, the vector that is perpendicular in the
/// world is T (W^T W)^-1 n for a normal n, and its length in the world is that of W^-T n. Products
/// of three and more entries of W overflow where W is large. So W = K C is taken apart, with the
/// powers of two C that bring the columns of K to about 1: the vector is
/// (T C^-1) (K^T K)^-1 (C^-1 n), and the length is that of K^-T (C^-1 n). Each factor has a unit of
/// its own. These are powers of two, so all digits are those of the plain products.
class Spaces {
 public:
  explicit Spaces(const NormalProjectOptions& options)
      : points_(options.transform.topRows<3>()),
        vectors_(invertibleLinearPart(options.transform, "transform")) {
    const Eigen::Matrix3d world = invertibleLinearPart(options.world, "world");
    const Exponents3 columns = columnExponents(world);
    const Eigen::Matrix3d in_units = withColumnsTimes(world, -columns);
    world_normals_ = in_units.inverse().transpose();
    Exponents3x3 exponents;
    for (int row = 0; row < 3; ++row) {
      exponents.row(row) = -columns;
      column_units_[row] = std::ldexp(1., std::max(columns.minCoeff() - columns[row], -1022));
    }
    const MatrixInOwnUnit to_source(vectors_, exponents);
    unit_ = to_source.unit;
    normals_ = to_source.matrix * (in_units.transpose() * in_units).inverse();
  }

  Vector3 point(const Vector3& p) const { return points_.leftCols<3>() * p + points_.col(3); }
  Vector3 vector(const Vector3& v) const { return vectors_ * v; }

  /// A ray's direction on the source for a normal, and how it came about.
  struct Direction {
    Vector3 along;
    double normal_unit, unit;  ///< powers of two that leave intermediate vectors at about 1
    double world_length;       ///< of `along`, times 2^-unit_
  };
  Direction direction(const Vector3& normal) const {
    Direction result;
    const Vector3 in_columns = column_units_.cwiseProduct(normal);
    result.normal_unit = scaleToOwnUnit(in_columns.cwiseAbs().maxCoeff());
    const Vector3 scaled = result.normal_unit * in_columns;
    const Vector3 along = normals_ * scaled;
    result.unit = scaleToOwnUnit(along.cwiseAbs().maxCoeff());
    result.along = result.unit * along;
    if (result.along.isZero(0)) {
      throw std::invalid_argument("transform and world leave the normal " + rowText(normal) +
                                  " no direction: the lengths of their axes differ by more than " +
                                  "1e300");
    }
    result.world_length = result.unit * (world_normals_ * scaled).norm();
    return result;
  }
  /// The step of `along` for a step of the normal, with the units fixed.
  Vector3 directionStep(const Direction& at, const Vector3& normal_step) const {
    const Vector3 in_columns = column_units_.cwiseProduct(normal_step);
    return at.unit * (normals_ * (at.normal_unit * in_columns));
  }
  /// A length in the world, in lengths of a direction on the source.
  double inLengthsOf(const Direction& direction, double length) const {
    return std::ldexp(length / direction.world_length, -unit_);
  }

 private:
  Eigen::Matrix<double, 3, 4> points_;  // to the source's space
  Eigen::Matrix3d vectors_;
  Eigen::Matrix3d normals_;        // (T C^-1) (K^T K)^-1, times 2^unit_
  Eigen::Matrix3d world_normals_;  // K^-T
  Vector3 column_units_;           // C^-1, in the unit in which its largest entry is 1
  int unit_;
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
  NormalRays(const TexelPlaces& places, const Spaces& spaces, const NormalProjectOptions& options,
             double farthest_origin)
      : spaces_(spaces), origins_(places.position.rows(), 3), made_(size(places)) {
    directions_.resize(origins_.rows(), 3);
    longest_.resize(origins_.rows());
    for (Eigen::Index row = 0; row < origins_.rows(); ++row) {
      const Vector3 position = places.position.row(row);
      origins_.row(row) = spaces.point(position);
      checkOrigin(position, origins_.row(row), farthest_origin);
      Spaces::Direction& made = made_[static_cast<std::size_t>(row)];
      made = spaces.direction(places.normal.row(row));
      directions_.row(row) = made.along;
      longest_[row] = spaces.inLengthsOf(made, options.max_distance);
    }
  }

  Vector3 direction(Eigen::Index row) const { return directions_.row(row); }
  /// The step of the place at this distance along a ray, for steps of its origin on the surface and
  /// of the normal there.
  Vector3 step(Eigen::Index row, double along, const Vector3& place, const Vector3& normal) const {
    return spaces_.vector(place) +
           along * spaces_.directionStep(made_[static_cast<std::size_t>(row)], normal);
  }

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
  static std::size_t size(const TexelPlaces& places) {
    return static_cast<std::size_t>(places.position.rows());
  }
  /// The caller knows the transform, and not the ray that it leads to.
  static void checkOrigin(const Vector3& position, const Vector3& origin, double farthest) {
    if (!(origin.cwiseAbs().maxCoeff() <= farthest) || !origin.allFinite()) {
      throw std::invalid_argument("transform takes the place " + rowText(position) +
                                  " of the surface to " + rowText(origin) +
                                  ", too far from the source: coordinates may go up to " +
                                  numberText(farthest));
    }
  }

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

  const Spaces& spaces_;
  Points origins_, directions_;
  std::vector<Spaces::Direction> made_;
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
  const NormalRays rays(places, spaces, options, source_search.farthestOrigin());
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
      return rays.step(row, found.along[row], place.row(row), normal.row(row));
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
    const Vector3 direction = rays.direction(row);
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
