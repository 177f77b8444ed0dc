// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/bake/projection.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "limitsurf/bake/projector.h"
#include "limitsurf/bake/texel_places.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kRowsPerTask = 512;

/// 0 up to 0, 1 from 1 on, a cubic between.
double smoothStep(double x) {
  const double t = std::clamp(x, 0., 1.);
  return t * t * (3 - 2 * t);
}

/// Angles between normals and directions, as the world has them.
class WorldAngles {
 public:
  explicit WorldAngles(const Eigen::Matrix4d& world)
      : linear_(invertibleLinearPart(world, "world")), normals_(linear_.inverse().transpose()) {}

  double cosine(const Vector3& normal, const Vector3& direction) const {
    return (normals_ * normal).normalized().dot((linear_ * direction).normalized());
  }

 private:
  Eigen::Matrix3d linear_, normals_;
};

/// The part of [x - reach, x + reach] that is in [0, 1].
double partInside(double x, double reach) {
  if (x >= reach && x <= 1 - reach) {
    return 1;
  }
  if (!(reach > 0)) {
    return 0;
  }
  return std::max(0., std::min(x + reach, 1.) - std::max(x - reach, 0.)) / (2 * reach);
}

/// Whether samples of texels can be seen from the eye.
class Visibility {
 public:
  Visibility(const LimitSurface& surface, const Projector& projector, const SurfaceSearch& occluder,
             const ProjectOptions& options, int threads)
      : surface_(surface),
        projector_(projector),
        occluder_(occluder),
        options_(options),
        threads_(threads) {
    const Points& cage = surface.positions();
    bias_ = options.bias ? *options.bias
            : cage.rows() > 0
                ? kRayBias * (cage.colwise().maxCoeff() - cage.colwise().minCoeff()).norm()
                : 0;
  }

  /// Multiplies each weight by the part of the texel's samples that are seen.
  void apply(Span<Location> at, const TexelPlaces& places, Eigen::VectorXd& weight) const {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = 0; row < weight.size(); ++row) {
      if (weight[row] > 0) {
        rows.push_back(row);
      }
    }
    if (rows.empty()) {
      return;
    }
    const auto samples = static_cast<std::size_t>(options_.samples);
    Points position, normal;
    if (samples == 1) {
      position = places.position(rows, Eigen::all);
      normal = places.normal(rows, Eigen::all);
    } else {
      evaluateSamples(at, places, rows, position, normal);
    }
    const std::vector<char> seen = areSeen(position, normal);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto count =
          std::count(seen.begin() + static_cast<std::ptrdiff_t>(i * samples),
                     seen.begin() + static_cast<std::ptrdiff_t>((i + 1) * samples), 1);
      weight[rows[i]] *= static_cast<double>(count) / static_cast<double>(samples);
    }
  }

 private:
  void evaluateSamples(Span<Location> at, const TexelPlaces& places,
                       const std::vector<Eigen::Index>& rows, Points& position,
                       Points& normal) const {
    const int side = options_.samples == 4 ? 2 : 4;
    std::vector<Location> samples;
    samples.reserve(rows.size() * static_cast<std::size_t>(options_.samples));
    for (const Eigen::Index row : rows) {
      const Location& middle = at[static_cast<std::size_t>(row)];
      const auto steps = places.parameters.row(row);
      for (int i = 0; i < side * side; ++i) {
        const double x = (i % side + 0.5) / side - 0.5, y = (i / side + 0.5) / side - 0.5;
        samples.push_back({middle.face, std::clamp(middle.u + x * steps[0] + y * steps[1], 0., 1.),
                           std::clamp(middle.v + x * steps[2] + y * steps[3], 0., 1.)});
      }
    }
    Evaluation e = surface_.evaluate(samples, Derivatives::first, true, threads_);
    position = std::move(e.position);
    normal = std::move(e.normal);
    for (Eigen::Index i = 0; i < normal.rows(); ++i) {
      if (!normal.row(i).allFinite()) {
        normal.row(i) = places.normal.row(rows[static_cast<std::size_t>(i) / (side * side)]);
      }
    }
  }

  std::vector<char> areSeen(const Points& position, const Points& normal) const {
    const auto count = static_cast<std::size_t>(position.rows());
    Points origins(position.rows(), 3), directions(position.rows(), 3);
    Eigen::VectorXd end(position.rows());
    std::vector<char> seen(count);
    parallelFor(count, kRowsPerTask, threads_, [&](std::size_t begin, std::size_t limit) {
      for (std::size_t i = begin; i < limit; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const Vector3 point = position.row(row);
        const Projector::View view = projector_.see(point);
        const bool front = normal.row(row).dot(view.to_eye) >= 0;
        const Vector3 origin = point + (front ? bias_ : -bias_) * normal.row(row).transpose();
        seen[i] = view.in_front && origin.allFinite();
        origins.row(row) = seen[i] ? origin : Vector3::Zero().eval();
        directions.row(row) = seen[i] ? view.to_eye : Vector3::UnitX().eval();
        end[row] = projector_.distanceToEye(origin);
        if (options_.depth) {
          end[row] = std::min(
              end[row], projector_.distanceToPlane(origin, view.to_eye, options_.depth->near));
        }
      }
    });
    const Hits hits =
        occluder_.rayCast(origins, directions, std::numeric_limits<double>::infinity(), threads_);
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (hits.at[i].face >= 0 && hits.distance[row] < end[row]) {
        seen[i] = 0;
      }
    }
    return seen;
  }

  const LimitSurface& surface_;
  const Projector& projector_;
  const SurfaceSearch& occluder_;
  const ProjectOptions& options_;
  int threads_;
  double bias_;
};

void refuse(const char* name, double value, const char* expected) {
  throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + "; expected " +
                              expected);
}

}  // namespace

void checkProject(const LimitSurface& surface, const SurfaceData& map,
                  const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                  const ProjectOptions& options) {
  checkMap(surface, map, "uv_map");
  checkTexel(texel);
  Projector(matrix, surface);
  invertibleLinearPart(options.world, "world");
  if (!(options.facing_start >= 0 && options.facing_start <= options.facing_end)) {
    refuse("facing's start", options.facing_start, "an angle from 0 to facing's end");
  }
  if (!(options.facing_end <= kPi)) {
    refuse("facing's end", options.facing_end, "an angle up to pi");
  }
  if (options.samples != 1 && options.samples != 4 && options.samples != 16) {
    throw std::invalid_argument("samples is " + std::to_string(options.samples) +
                                "; expected 1, 4 or 16");
  }
  if (options.bias && !(*options.bias >= 0 && std::isfinite(*options.bias))) {
    refuse("bias", *options.bias, "a length, 0 or more");
  }
  if (!(options.soft_edge >= 0 && options.soft_edge <= 0.5)) {
    refuse("soft_edge", options.soft_edge, "0 to 0.5");
  }
  if (options.depth && !(options.depth->near < options.depth->far)) {
    refuse("depth's near", options.depth->near, "less than far");
  }
}

Projection project(const LimitSurface& surface, const SurfaceData& map, Span<Location> at,
                   const Eigen::Matrix4d& matrix, const Eigen::Vector2d& texel,
                   const SurfaceSearch* occluder, const ProjectOptions& options, int threads) {
  checkThreads(threads);
  checkProject(surface, map, matrix, texel, options);
  const Projector projector(matrix, surface);
  const WorldAngles angles(options.world);
  const TexelPlaces places = texelPlaces(surface, map, at, texel, false, threads);

  const auto rows = static_cast<Eigen::Index>(at.size());
  Projection result;
  result.st.setConstant(rows, 2, kNaN);
  result.footprint.setZero(rows, 4);
  result.weight.setZero(rows);
  const auto facing = [&](double cosine) {
    const double toward = options.two_sided ? std::abs(cosine) : cosine;
    const double angle = std::acos(std::clamp(toward, -1., 1.));
    const double fall = options.facing_end - options.facing_start;
    return angle >= options.facing_end     ? 0.
           : angle <= options.facing_start ? 1.
                                           : 1 - smoothStep((angle - options.facing_start) / fall);
  };
  const auto framing = [&](double x, double reach) {
    const double border = std::min(x, 1 - x);
    const double soft = options.soft_edge > 0 ? smoothStep(border / options.soft_edge) : 1;
    return (options.frame ? partInside(x, reach) : 1) * soft;
  };
  parallelFor(at.size(), kRowsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Projector::View view = projector.see(places.position.row(row));
      if (!view.in_front) {
        continue;
      }
      Eigen::Matrix<double, 3, 2> steps;
      steps << places.along_x.row(row).transpose(), places.along_y.row(row).transpose();
      const Eigen::Matrix2d footprint = shortened(view.st_by_point * steps);
      result.st.row(row) = view.st;
      result.footprint.row(row) << footprint(0, 0), footprint(0, 1), footprint(1, 0),
          footprint(1, 1);
      if (options.depth &&
          !(view.depth >= options.depth->near && view.depth <= options.depth->far)) {
        continue;
      }
      const Eigen::Vector2d reach = footprint.cwiseAbs().rowwise().sum() / 2;
      result.weight[row] = facing(angles.cosine(places.normal.row(row), view.to_eye)) *
                           framing(view.st[0], reach[0]) * framing(view.st[1], reach[1]);
    }
  });
  if (occluder) {
    Visibility(surface, projector, *occluder, options, threads).apply(at, places, result.weight);
  }
  return result;
}

}  // namespace limitsurf
