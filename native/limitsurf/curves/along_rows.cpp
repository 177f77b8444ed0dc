// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/along_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "limitsurf/curves/scatter_along.h"
#include "limitsurf/mesh/messages.h"
#include "limitsurf/parallel.h"

namespace limitsurf {
namespace {

/// The curves are sampled so many times in the distance between rows.
constexpr double kSamplesPerStep = 4;
constexpr std::int64_t kMostSamples = std::int64_t{1} << 23;
constexpr std::size_t kSamplesPerTask = 256;
/// A row ends where the curves are nearer than this part of its distance: half of what is allowed.
/// The other half is for the shots, whose directions are 0.15 radians apart: one of them is at most
/// 1 / cos(0.075) = 1.003 as long as the shortest way.
constexpr double kNearer = 1 - kRowError / 2;
constexpr double kTurns[] = {0, 0.15, -0.15, 0.3, -0.3};

/// The arc lengths of samples, evenly on each curve.
struct Samples {
  std::vector<int> curve, next, before;
  std::vector<double> arc;

  Samples(const EdgeCurves& curves, double spacing) {
    double total = 0;
    for (int i = 0; i < curves.count(); ++i) {
      total += curves.length(i);
    }
    if (total / spacing > static_cast<double>(kMostSamples)) {
      throw std::invalid_argument(text("row_distance is too small for curves with a length of ",
                                       total, ": they would be divided into more than ",
                                       kMostSamples, " parts to compare the rows"));
    }
    for (int i = 0; i < curves.count(); ++i) {
      const int first = static_cast<int>(curve.size());
      const auto parts = static_cast<int>(std::ceil(curves.length(i) / spacing)) + 1;
      const int count = curves.closed(i) ? parts : parts + 1;
      for (int k = 0; k < count; ++k) {
        curve.push_back(i);
        arc.push_back(std::min(curves.length(i) * k / parts, curves.length(i)));
        next.push_back(k + 1 < count ? first + k + 1 : curves.closed(i) ? first : -1);
        before.push_back(k > 0 ? first + k - 1 : curves.closed(i) ? first + count - 1 : -1);
      }
    }
  }
};

std::vector<std::pair<int, int>> verticesOfEdges(const EdgeCurves& curves) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(curves.edgeCount()));
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    edges.push_back(curves.edgeVertices(edge));
  }
  return edges;
}

Points positionsOf(const EdgeCurves& curves, const Samples& samples, int threads) {
  Points positions(static_cast<Eigen::Index>(samples.arc.size()), 3);
  parallelFor(samples.arc.size(), kSamplesPerTask, threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  positions.row(static_cast<Eigen::Index>(i)) =
                      curves.at(samples.curve[i], samples.arc[i]).position;
                }
              });
  return positions;
}

}  // namespace

AlongRows::AlongRows(const LimitSurface& surface, const EdgeCurves& curves, double step,
                     double most, int threads)
    : tracer_(surface, threads),
      targets_(tracer_.targets(verticesOfEdges(curves))),
      spacing_(step / kSamplesPerStep),
      grid_(Points(0, 3), 1) {
  Samples samples(curves, spacing_);
  samples_ = positionsOf(curves, samples, threads);
  next_ = std::move(samples.next);
  before_ = std::move(samples.before);
  grid_ = PointGrid(samples_, most);
}

bool AlongRows::place(const Location& foot, const Vector3& inward, double distance,
                      GeodesicTracer::Stop& out) const {
  const GeodesicTracer::Path path = tracer_.trace(foot, inward, {distance}, &targets_);
  if (path.stops.empty() || isNearer(path.stops.front(), distance)) {
    return false;
  }
  out = path.stops.front();
  return true;
}

/// Whether a geodesic that is shorter than the distance leads to the curves. Places of the curves
/// that are nearer in space are looked for first: where there are none, no geodesic can be shorter.
/// Geodesics are shot towards each one that is a local minimum of the distance in space.
bool AlongRows::isNearer(const GeodesicTracer::Stop& at, double distance) const {
  const double enough = kNearer * distance;
  std::vector<int> near;
  grid_.near(at.position, enough + spacing_, near);
  const auto segmentDistance = [&](int i, Vector3& closest) {
    const Vector3 a = samples_.row(i);
    const int j = next_[static_cast<std::size_t>(i)];
    if (j < 0) {
      closest = a;
    } else {
      const Vector3 along = samples_.row(j).transpose() - a;
      const double squared = along.squaredNorm();
      const double x = squared > 0 ? std::clamp((at.position - a).dot(along) / squared, 0., 1.) : 0;
      closest = a + x * along;
    }
    return (at.position - closest).norm();
  };
  for (const int i : near) {
    Vector3 closest, other;
    const double here = segmentDistance(i, closest);
    const int before = before_[static_cast<std::size_t>(i)];
    const int next = next_[static_cast<std::size_t>(i)];
    if (!(here < enough) || (before >= 0 && segmentDistance(before, other) < here) ||
        (next >= 0 && segmentDistance(next, other) < here)) {
      continue;
    }
    const Vector3 towards = closest - at.position;
    for (const double turn : kTurns) {
      const GeodesicTracer::Path shot =
          tracer_.trace(at.at, Eigen::AngleAxisd(turn, at.normal) * towards, {enough}, &targets_);
      if (shot.hit) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace limitsurf
