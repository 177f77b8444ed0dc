// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/project/visibility.h"

#include <algorithm>
#include <limits>

#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The rounding of coordinates far from the origin: 16 units in the last place.
constexpr double kRoundingBias = 0x1p-48;

double defaultBias(const Points& cage) {
  if (cage.rows() == 0) {
    return 0;
  }
  const double diagonal = (cage.colwise().maxCoeff() - cage.colwise().minCoeff()).norm();
  return kRayBias * diagonal + kRoundingBias * cage.cwiseAbs().maxCoeff();
}

}  // namespace

Visibility::Visibility(const LimitSurface& surface, const Projector& projector,
                       const SurfaceSearch& occluder, const ProjectOptions& options, int threads)
    : surface_(surface),
      projector_(projector),
      occluder_(occluder),
      options_(options),
      threads_(threads),
      bias_(options.bias ? *options.bias : defaultBias(surface.positions())) {}

void Visibility::apply(const LocationBatch& at, const TexelPlaces& places,
                       Eigen::VectorXd& weight) const {
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
    const auto count = std::count(seen.begin() + static_cast<std::ptrdiff_t>(i * samples),
                                  seen.begin() + static_cast<std::ptrdiff_t>((i + 1) * samples), 1);
    weight[rows[i]] *= static_cast<double>(count) / static_cast<double>(samples);
  }
}

void Visibility::evaluateSamples(const LocationBatch& at, const TexelPlaces& places,
                                 const std::vector<Eigen::Index>& rows, Points& position,
                                 Points& normal) const {
  const int side = options_.samples == 4 ? 2 : 4;
  std::vector<Location> samples;
  samples.reserve(rows.size() * static_cast<std::size_t>(options_.samples));
  for (const Eigen::Index row : rows) {
    const Location middle = at[static_cast<std::size_t>(row)];
    const auto steps = places.parameters.row(row);
    for (int i = 0; i < side * side; ++i) {
      const int column = i % side, row_of_samples = i / side;
      const double x = (column + 0.5) / side - 0.5, y = (row_of_samples + 0.5) / side - 0.5;
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

std::vector<char> Visibility::areSeen(const Points& position, const Points& normal) const {
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
        end[row] = std::min(end[row],
                            projector_.distanceToPlane(origin, view.to_eye, options_.depth->near));
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

}  // namespace limitsurf
