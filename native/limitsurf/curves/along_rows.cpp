// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/along_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/curves/scatter_along.h"

namespace limitsurf {
namespace {

/// The curves are sampled so many times in the distance between rows.
constexpr double kSamplesPerStep = 16;
/// A row ends where the curves are nearer than this part of its distance: half of what is allowed.
/// The other half is for the shots, whose directions are 0.15 radians apart: one of them is at most
/// 1 / cos(0.075) = 1.003 as long as the shortest way.
constexpr double kNearer = 1 - kRowError / 2;
constexpr double kTurns[] = {0, 0.15, -0.15, 0.3, -0.3};
/// A vertex of the curves is aimed at so many times; each shot corrects the one before. It counts
/// as reached within this part of the row's distance.
constexpr int kAims = 6;
constexpr double kReached = 1e-3;

std::vector<std::pair<int, int>> verticesOfEdges(const EdgeCurves& curves) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(curves.edgeCount()));
  for (std::int64_t edge = 0; edge < curves.edgeCount(); ++edge) {
    edges.push_back(curves.edgeVertices(edge));
  }
  return edges;
}

}  // namespace

AlongRows::AlongRows(const LimitSurface& surface, const EdgeCurves& curves, double step,
                     double most, int threads)
    : surface_(surface),
      tracer_(surface, threads),
      targets_(tracer_.targets(verticesOfEdges(curves))),
      spacing_(step / kSamplesPerStep),
      samples_(curves, spacing_, threads),
      grid_(samples_.positions, most) {}

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
    const Vector3 a = samples_.positions.row(i);
    const int j = samples_.next[static_cast<std::size_t>(i)];
    if (j < 0) {
      closest = a;
    } else {
      const Vector3 along = samples_.positions.row(j).transpose() - a;
      const double squared = along.squaredNorm();
      const double x = squared > 0 ? std::clamp((at.position - a).dot(along) / squared, 0., 1.) : 0;
      closest = a + x * along;
    }
    return (at.position - closest).norm();
  };
  for (const int i : near) {
    Vector3 closest, other;
    const double here = segmentDistance(i, closest);
    const int before = samples_.before[static_cast<std::size_t>(i)];
    const int next = samples_.next[static_cast<std::size_t>(i)];
    if (!(here < enough) || (before >= 0 && segmentDistance(before, other) < here) ||
        (next >= 0 && segmentDistance(next, other) < here)) {
      continue;
    }
    const Vector3 towards = closest - at.position;
    if (closest == samples_.positions.row(i).transpose() && reachesVertex(at, i, enough)) {
      return true;
    }
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

/// Whether a geodesic of at most this length leads to the vertex at a sample of the curves. Shots
/// beside an end of a curve pass it, and those beside a corner are much longer, so that the vertex
/// itself has to be met. Errors of the direction are measured at the shot's end.
bool AlongRows::reachesVertex(const GeodesicTracer::Stop& at, int sample, double most) const {
  const int vertex = samples_.vertex[static_cast<std::size_t>(sample)];
  const Vector3 goal = samples_.positions.row(sample);
  Vector3 direction = goal - at.position;
  double length = direction.norm();
  for (int aim = 0; aim < kAims && vertex >= 0 && length <= most; ++aim) {
    const GeodesicTracer::Path shot = tracer_.trace(at.at, direction, {length}, &targets_);
    if (shot.hit) {
      return true;
    }
    if (shot.stops.empty()) {
      return false;
    }
    const GeodesicTracer::Stop& end = shot.stops.front();
    const Vector3 missing = goal - end.position;
    if (missing.norm() <= kReached * most && hasVertex(end.at, vertex)) {
      return length + missing.norm() <= most;
    }
    const double aside = end.normal.cross(end.direction).dot(missing);
    direction = Eigen::AngleAxisd(aside / length, at.normal) * direction;
    length += end.direction.dot(missing);
  }
  return false;
}

bool AlongRows::hasVertex(const Location& at, int vertex) const {
  const int face = surface_.baseFace()[static_cast<std::size_t>(at.face)];
  const Span<int> vertices = surface_.mesh().faceVertices(face);
  return std::find(vertices.begin(), vertices.end(), vertex) != vertices.end();
}

}  // namespace limitsurf
