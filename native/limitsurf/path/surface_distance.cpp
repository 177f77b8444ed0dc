// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/error.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/number_text.h"

namespace limitsurf {
namespace {

constexpr double kGolden = 0.6180339887498949;

Vector3 pointOf(const Segment& segment, double t) {
  return (1 - t) * segment.from + t * segment.to;
}

}  // namespace

void checkTolerance(double tolerance) {
  if (!(tolerance > 0 && std::isfinite(tolerance))) {
    throw std::invalid_argument("tolerance is " + numberText(tolerance) +
                                "; it must be more than 0 and finite");
  }
}

Hits feet(const SurfaceSearch& search, const Points& points, int threads) {
  Hits hits = search.closest(points, {}, threads);
  if (!hits.at.empty() && hits.at.front().face < 0) {
    throw MeshError("no face of the mesh has a limit surface, so nothing can lie on it");
  }
  return hits;
}

Hits feet(const SurfaceSearch& search, const std::vector<Vector3>& points, int threads) {
  Points rows(static_cast<Eigen::Index>(points.size()), 3);
  InterruptionStride stride;
  for (std::size_t i = 0; i < points.size(); ++i) {
    stride.step();
    rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return feet(search, rows, threads);
}

double distanceFromSegment(const Vector3& from, const Vector3& to, const Vector3& point) {
  const Vector3 along = to - from;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((point - from).dot(along) / squared, 0., 1.) : 0;
  return (from + t * along - point).norm();
}

std::vector<double> largestDistances(const SurfaceSearch& search,
                                     const std::vector<Segment>& segments, int threads) {
  const std::size_t count = segments.size();
  std::vector<Vector3> probes;
  probes.reserve(count * kDistanceProbes);
  constexpr double kStep = 1. / (kDistanceProbes + 1);
  for (const Segment& segment : segments) {
    for (int i = 1; i <= kDistanceProbes; ++i) {
      probes.push_back(pointOf(segment, i * kStep));
    }
  }
  const Hits probed = feet(search, probes, threads);
  std::vector<double> largest(count), low(count), high(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* begin = probed.distance.data() + i * kDistanceProbes;
    const auto at = std::max_element(begin, begin + kDistanceProbes) - begin;
    largest[i] = begin[at];
    low[i] = static_cast<double>(at) * kStep;
    high[i] = static_cast<double>(at + 2) * kStep;
  }
  std::vector<Vector3> pair(2 * count);
  for (int step = 0; step < kGoldenSteps; ++step) {
    for (std::size_t i = 0; i < count; ++i) {
      const double width = kGolden * (high[i] - low[i]);
      pair[2 * i] = pointOf(segments[i], high[i] - width);
      pair[2 * i + 1] = pointOf(segments[i], low[i] + width);
    }
    const Hits found = feet(search, pair, threads);
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(2 * i);
      const double width = kGolden * (high[i] - low[i]);
      const double left = found.distance[row], right = found.distance[row + 1];
      largest[i] = std::max({largest[i], left, right});
      (left > right ? high[i] : low[i]) = left > right ? low[i] + width : high[i] - width;
    }
  }
  return largest;
}

}  // namespace limitsurf
