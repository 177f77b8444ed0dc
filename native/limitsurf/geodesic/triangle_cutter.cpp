// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/triangle_cutter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "limitsurf/geodesic/triangle_cells.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// A section that passes a point closer than this share of a side goes through the point.
constexpr double kThroughPoint = 1e-6;
/// The longest way along sides that is cut where no section leads to the target, by the distance.
constexpr double kLongestDetour = 3;
/// A step of a section that comes no nearer to its target than this share of the distance is none.
constexpr double kLeastStep = 1e-9;

SurfaceTriangles::Corner between(const SurfaceTriangles::Corner& a,
                                 const SurfaceTriangles::Corner& b, double share) {
  const auto mixed = [share](std::int32_t p, std::int32_t q) {
    return static_cast<std::int32_t>(std::lround(p + share * (static_cast<double>(q) - p)));
  };
  return {mixed(a.u, b.u), mixed(a.v, b.v)};
}

}  // namespace

TriangleCutter::TriangleCutter(SurfaceTriangles& triangles)
    : triangles_(triangles),
      around_(triangles.points.size(), triangles.vertices),
      whole_count_(triangles.vertices.size()) {}

int TriangleCutter::insert(int triangle, const Location& at, double tolerance) {
  const auto pieces = pieces_.find(triangle);
  if (pieces != pieces_.end()) {
    const int deepest_piece = deepest(triangles_, pieces->second, at);
    if (deepest_piece < 0) {  // rounding has left none of the pieces an area in (u, v)
      return triangles_.vertices[triangle][0];
    }
    triangle = deepest_piece;
  }
  if (triangle < 0) {
    return -1;
  }
  std::array<double, 3> weights = barycentric(triangles_.corners[triangle], at.u, at.v);
  double sum = 0;
  for (double& weight : weights) {
    weight = std::max(weight, 0.);
    sum += weight;
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  const std::array<int, 3>& points = triangles_.vertices[triangle];
  for (int k = 0; k < 3; ++k) {
    if (weights[k] > 1 - tolerance) {
      return points[k];
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (weights[k] < tolerance) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      return splitSide(points[i], points[j], weights[j] / (weights[i] + weights[j]));
    }
  }
  return splitTriangle(triangle, weights);
}

/// Adds a triangle that is equal to another one.
int TriangleCutter::addTriangle(int like) {
  const int number = static_cast<int>(triangles_.vertices.size());
  const auto again = [like](auto& rows) {
    const auto copy = rows[like];
    rows.push_back(copy);
  };
  again(triangles_.vertices);
  again(triangles_.corners);
  again(triangles_.is_cut);
  again(triangles_.face);
  around_.addTriangle(triangles_.vertices[number]);
  const bool is_piece = static_cast<std::size_t>(like) >= whole_count_;
  const int origin = is_piece ? origin_[like - whole_count_] : like;
  origin_.push_back(origin);
  std::vector<int>& pieces = pieces_[origin];
  if (pieces.empty()) {
    pieces.push_back(origin);
  }
  pieces.push_back(number);
  return number;
}

/// Gives a corner of a triangle another point.
void TriangleCutter::place(int triangle, int corner, int point, SurfaceTriangles::Corner at) {
  around_.moveCorner(triangle, corner, triangles_.vertices[triangle][corner], point);
  triangles_.vertices[triangle][corner] = point;
  triangles_.corners[triangle][corner] = at;
}

int TriangleCutter::cornerOf(int triangle, int point) const {
  const std::array<int, 3>& points = triangles_.vertices[triangle];
  for (int k = 0; k < 3; ++k) {
    if (points[k] == point) {
      return k;
    }
  }
  return -1;
}

/// Divides all triangles at a side.
int TriangleCutter::splitSide(int a, int b, double share) {
  const int point = static_cast<int>(triangles_.points.size());
  const Vector3 from = triangles_.points[a], to = triangles_.points[b];
  triangles_.points.push_back(from + share * (to - from));
  around_.addPoint();
  const std::vector<int> at_a(around_[a].begin(), around_[a].end());
  for (const int first : at_a) {
    const int corner_b = cornerOf(first, b);
    if (corner_b < 0) {
      continue;
    }
    const int corner_a = cornerOf(first, a);
    const auto middle =
        between(triangles_.corners[first][corner_a], triangles_.corners[first][corner_b], share);
    const int second = addTriangle(first);
    place(first, corner_b, point, middle);
    place(second, corner_a, point, middle);
    // the side between both halves is new: the one that does not touch a in the first half
    triangles_.is_cut[first][(corner_a + 1) % 3] = 0;
    triangles_.is_cut[second][(corner_b + 1) % 3] = 0;
  }
  return point;
}

int TriangleCutter::splitTriangle(int triangle, const std::array<double, 3>& weights) {
  const int point = static_cast<int>(triangles_.points.size());
  const std::array<int, 3> points = triangles_.vertices[triangle];
  const std::array<SurfaceTriangles::Corner, 3> corners = triangles_.corners[triangle];
  Vector3 position = Vector3::Zero();
  double u = 0, v = 0;
  for (int k = 0; k < 3; ++k) {
    position += weights[k] * triangles_.points[points[k]];
    u += weights[k] * corners[k].u;
    v += weights[k] * corners[k].v;
  }
  const SurfaceTriangles::Corner middle{static_cast<std::int32_t>(std::lround(u)),
                                        static_cast<std::int32_t>(std::lround(v))};
  triangles_.points.push_back(position);
  around_.addPoint();
  const std::array<int, 3> parts = {triangle, addTriangle(triangle), addTriangle(triangle)};
  for (int k = 0; k < 3; ++k) {
    // the part keeps the side from corner k + 1 to corner k + 2
    place(parts[k], k, point, middle);
    triangles_.is_cut[parts[k]][k] = triangles_.is_cut[parts[k]][(k + 2) % 3] = 0;
  }
  return point;
}

void TriangleCutter::release() {
  InterruptionStride stride;
  while (!pieces_.empty()) {
    stride.step();
    pieces_.erase(pieces_.begin());
  }
}

double TriangleCutter::distance(int a, int b) const {
  return (triangles_.points[a] - triangles_.points[b]).norm();
}

bool TriangleCutter::isSide(int a, int b) const {
  return std::any_of(around_[a].begin(), around_[a].end(),
                     [&](int triangle) { return cornerOf(triangle, b) >= 0; });
}

void TriangleCutter::cutSide(int a, int b) {
  for (const int triangle : around_[a]) {
    const int corner_a = cornerOf(triangle, a), corner_b = cornerOf(triangle, b);
    if (corner_b >= 0) {
      triangles_.is_cut[triangle][(corner_a + 1) % 3 == corner_b ? corner_a : corner_b] = 1;
    }
  }
}

/// The normal at a point, to the side of `like`, times an area. Faces of a mesh that is not
/// oriented may have opposite orders.
Vector3 TriangleCutter::normalAround(int point, const Vector3& like) const {
  Vector3 sum = like;
  for (const int triangle : around_[point]) {
    const auto& [a, b, c] = triangles_.vertices[triangle];
    const Vector3& origin = triangles_.points[a];
    const Vector3 across = (triangles_.points[b] - origin).cross(triangles_.points[c] - origin);
    sum += sum.dot(across) < 0 ? Vector3(-across) : across;
  }
  return sum;
}

/// Where the section leaves the triangles at a point in the direction of the target.
std::optional<TriangleCutter::Crossing> TriangleCutter::nextCrossing(int at, int to,
                                                                     const Vector3& across) const {
  const Vector3 origin = triangles_.points[at], target = triangles_.points[to];
  const Vector3 direction = (target - origin).normalized();
  std::optional<Crossing> best;
  double best_forward = 0;
  for (const int triangle : around_[at]) {
    const int corner = cornerOf(triangle, at);
    const int a = triangles_.vertices[triangle][(corner + 1) % 3];
    const int b = triangles_.vertices[triangle][(corner + 2) % 3];
    const Vector3 &pa = triangles_.points[a], &pb = triangles_.points[b];
    const double side_a = across.dot(pa - target), side_b = across.dot(pb - target);
    if (side_a * side_b > 0 || side_a == side_b) {
      continue;
    }
    const double share = side_a / (side_a - side_b);
    const Vector3 position = pa + share * (pb - pa);
    const double forward = direction.dot((position - origin).normalized());
    if (forward > best_forward && (target - position).norm() < (target - origin).norm()) {
      best_forward = forward;
      best = Crossing{a, b, share};
    }
  }
  return best;
}

void TriangleCutter::connect(int from, int to) {
  if (from == to || from < 0 || to < 0) {
    return;
  }
  const Vector3 normal = normalAround(to, normalAround(from, Vector3::Zero()));
  const Vector3 across =
      (triangles_.points[to] - triangles_.points[from]).cross(normal).normalized();
  int at = from;
  double nearest = distance(from, to);
  InterruptionStride stride;
  while (!isSide(at, to)) {
    stride.step();
    const std::optional<Crossing> found = nextCrossing(at, to, across);
    const int next = !found                         ? at
                     : found->share < kThroughPoint ? found->a
                     : found->share > 1 - kThroughPoint
                         ? found->b
                         : splitSide(found->a, found->b, found->share);
    const double left = distance(next, to);
    if (left >= nearest * (1 - kLeastStep)) {
      cutShortestWay(at, to);
      return;
    }
    nearest = left;
    cutSide(at, next);
    if (next == to) {
      return;
    }
    at = next;
  }
  cutSide(at, to);
}

/// Cuts the shortest way along sides (Dijkstra's algorithm), unless it is a detour.
void TriangleCutter::cutShortestWay(int from, int to) {
  const double longest = kLongestDetour * distance(from, to);
  struct Reached {
    double length;
    int before;
  };
  std::unordered_map<int, Reached> reached = {{from, {0, from}}};
  using Waiting = std::pair<double, int>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> waiting;
  waiting.push({0, from});
  InterruptionStride stride;
  while (!waiting.empty() && waiting.top().second != to) {
    stride.step();
    const auto [length, point] = waiting.top();
    waiting.pop();
    if (length > reached[point].length) {
      continue;
    }
    for (const int triangle : around_[point]) {
      for (const int next : triangles_.vertices[triangle]) {
        const double there = length + distance(point, next);
        const auto known = reached.find(next);
        if (there <= longest && (known == reached.end() || there < known->second.length)) {
          reached[next] = {there, point};
          waiting.push({there, next});
        }
      }
    }
  }
  if (waiting.empty()) {
    return;
  }
  for (int point = to; point != from; point = reached[point].before) {
    cutSide(reached[point].before, point);
  }
}

}  // namespace limitsurf
