// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/project/projection.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/direction_maps.h"
#include "limitsurf/number_text.h"
#include "limitsurf/parallel.h"
#include "limitsurf/pi.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/project/visibility.h"
#include "limitsurf/surface/map_derivatives.h"
#include "limitsurf/uv/texel_places.h"

namespace limitsurf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The cubic that rises from 0 at 0 to 1 at 1, continued by 0 and 1.
double smoothStep(double x) {
  const double t = std::clamp(x, 0., 1.);
  return t * t * (3 - 2 * t);
}

/// Angles between normals and directions, measured in world space.
class WorldAngles {
 public:
  explicit WorldAngles(const Eigen::Matrix4d& world)
      : to_world_(invertibleLinearPart(world, "world")) {}

  double cosine(const Vector3& normal, const Vector3& direction) const {
    return safelyNormalized(to_world_.normals * normal)
        .dot(safelyNormalized(to_world_.vectors * direction));
  }

 private:
  DirectionMaps to_world_;
};

/// The part of [x - reach, x + reach] that lies in [0, 1].
double partInside(double x, double reach) {
  if (x >= reach && x <= 1 - reach) {
    return 1;
  }
  if (!(reach > 0)) {
    return 0;
  }
  return std::clamp((std::min(x + reach, 1.) - std::max(x - reach, 0.)) / (2 * reach), 0., 1.);
}

void refuse(const char* name, double value, const char* expected) {
  throw std::invalid_argument(std::string(name) + " is " + numberText(value) + "; expected " +
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
    refuse("facing[0]", options.facing_start, "an angle from 0 to facing[1]");
  }
  if (!(options.facing_end <= kPi<double>)) {
    refuse("facing[1]", options.facing_end, "an angle up to pi");
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
    refuse("depth[0]", options.depth->near, "less than depth[1]");
  }
}

Projection project(const LimitSurface& surface, const SurfaceData& map, const LocationBatch& at,
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
