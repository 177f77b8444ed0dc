// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/shortest_ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "limitsurf/geodesic/nearest_sources.h"
#include "limitsurf/geodesic/unfolding.h"

namespace limitsurf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The level of the triangles: faces are divided until there are kQuads of them.
constexpr int kMostLevel = 6;
constexpr double kQuads = 1 << 14;

std::vector<int> levelsFor(const LimitSurface& surface) {
  const auto faces = surface.mesh().faceCount();
  int level = 0;
  while (level < kMostLevel && std::ldexp(static_cast<double>(faces), 2 * level) < kQuads) {
    ++level;
  }
  return std::vector<int>(static_cast<std::size_t>(faces), level);
}

/// A way across triangles is compared with one along their sides, if it is longer than the distance
/// by more than this: among long thin triangles it may turn back and forth.
constexpr double kAsExpected = 1.05;

/// What is closer to a vertex or a side than this share of a triangle lies on it.
constexpr double kOn = 1e-12;

/// A point on the side from vertex a to vertex b, by its share; a itself if b is a, too.
struct SidePoint {
  int a, b;
  double share;

  bool isVertex() const { return a == b; }
};

SidePoint sidePoint(int a, int b, double share) {
  if (share <= kOn || share >= 1 - kOn) {
    const int vertex = share <= kOn ? a : b;
    return {vertex, vertex, 0};
  }
  return {a, b, share};
}

struct Way {
  std::vector<WayPart> parts;
  double length = 0;
};

/// Goes from a place down the distances from an end.
class Descent {
 public:
  Descent(const GeodesicMesh& mesh, const NearestSources& distances, const Location& from,
          const MeshPlace& begin, const Location& to, const MeshPlace& end)
      : mesh_(mesh),
        distances_(distances),
        from_(from),
        begin_(begin),
        to_(to),
        end_(end.position),
        last_triangle_(end.triangle) {}

  /// Straight across triangles, or from vertex to vertex only. No parts if it leads nowhere.
  Way go(bool across) {
    Way way;
    Vector3 here = begin_.position;
    std::optional<SidePoint> at = begin();
    std::vector<int> ahead = at ? around(*at) : std::vector<int>{begin_.triangle};
    // a way that circles is given up
    for (std::size_t step = 0; step <= 2 * mesh_.triangleCount(); ++step) {
      if (std::find(ahead.begin(), ahead.end(), last_triangle_) != ahead.end()) {
        way.parts.push_back({locate(last_triangle_, at), to_});
        way.length += (end_ - here).norm();
        return way;
      }
      Step best;
      for (const int triangle : ahead) {
        offerVertices(triangle, at, across, best);
        if (across) {
          offerSides(triangle, at, best);
        }
      }
      if (!(best.rest < kInfinity)) {
        break;
      }
      way.parts.push_back({locate(best.triangle, at), locate(best.triangle, best.to)});
      at = best.to;
      way.length += (position(at) - here).norm();
      here = position(at);
      ahead = around(best.to);
    }
    return {};
  }

 private:
  struct Step {
    double rest = kInfinity;  ///< the length of the way from here to the end
    int triangle = -1;        ///< through which it goes
    SidePoint to{};
  };

  double toEnd(int vertex) const {
    const auto known = distances_.at(vertex);
    return known.size() > 0 ? known[0].distance : kInfinity;
  }

  Vector3 position(const std::optional<SidePoint>& at) const {
    return at ? Vector3((1 - at->share) * mesh_.position(at->a) + at->share * mesh_.position(at->b))
              : begin_.position;
  }

  void offerVertices(int triangle, const std::optional<SidePoint>& at, bool across,
                     Step& best) const {
    const Vector3 here = position(at);
    for (const int vertex : mesh_.triangle(triangle)) {
      if (at && at->isVertex() && (vertex == at->a || !(toEnd(vertex) < toEnd(at->a)))) {
        continue;
      }
      // Ways from vertex to vertex descend as steeply as they can.
      const double rest = toEnd(vertex) + (across ? (mesh_.position(vertex) - here).norm() : 0);
      if (rest < best.rest) {
        best = {rest, triangle, {vertex, vertex, 0}};
      }
    }
  }

  /// Offers the sides on which the way is not yet.
  void offerSides(int triangle, const std::optional<SidePoint>& at, Step& best) const {
    const Vector3 here = position(at);
    const auto& vertices = mesh_.triangle(triangle);
    for (int k = 0; k < 3; ++k) {
      const int a = vertices[k], b = vertices[(k + 1) % 3];
      const bool is_on =
          at && (at->isVertex() ? at->a == a || at->a == b
                                : (at->a == a && at->b == b) || (at->a == b && at->b == a));
      if (is_on || !(toEnd(a) < kInfinity && toEnd(b) < kInfinity)) {
        continue;
      }
      const UnfoldedWay way = unfoldedWay(toEnd(a), toEnd(b),
                                          {mesh_.distance(a, b), (mesh_.position(a) - here).norm(),
                                           (mesh_.position(b) - here).norm()});
      if (way.distance < best.rest) {
        best = {way.distance, triangle, sidePoint(a, b, way.share)};
      }
    }
  }

  /// The vertex or side on which the way begins, if it begins on one.
  std::optional<SidePoint> begin() const {
    const std::array<double, 3> weights = mesh_.weights(begin_.triangle, from_);
    const auto& vertices = mesh_.triangle(begin_.triangle);
    for (int k = 0; k < 3; ++k) {
      if (weights[k] <= kOn) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        return sidePoint(vertices[a], vertices[b], weights[b] / (weights[a] + weights[b]));
      }
    }
    return std::nullopt;
  }

  /// The triangles at a vertex or a side: the distances of a side's ends do not tell from which of
  /// its two triangles they come.
  std::vector<int> around(const SidePoint& at) const {
    std::vector<int> found;
    for (const int triangle : mesh_.trianglesAt(at.a)) {
      const auto& vertices = mesh_.triangle(triangle);
      if (std::find(vertices.begin(), vertices.end(), at.b) != vertices.end()) {
        found.push_back(triangle);
      }
    }
    return found;
  }

  Location locate(int triangle, const std::optional<SidePoint>& at) const {
    if (!at) {
      return from_;
    }
    const auto& vertices = mesh_.triangle(triangle);
    const auto corner = [&](int vertex) {
      const auto k = std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin();
      return mesh_.at(triangle, static_cast<int>(k));
    };
    const Location a = corner(at->a), b = corner(at->b);
    return {a.face, a.u + at->share * (b.u - a.u), a.v + at->share * (b.v - a.v)};
  }

  const GeodesicMesh& mesh_;
  const NearestSources& distances_;
  Location from_;
  MeshPlace begin_;
  Location to_;
  Vector3 end_;
  int last_triangle_;
};

}  // namespace

ShortestWays::ShortestWays(const LimitSurface& surface, int threads)
    : surface_(surface), mesh_(surface, levelsFor(surface), {}, threads, {}) {}

std::vector<WayPart> ShortestWays::find(const Location& from, const Location& to,
                                        double longest) const {
  const Points ends = surface_.evaluate(std::vector<Location>{from, to}).position;
  const MeshPlace begin{ends.row(0), mesh_.triangleAt(from)};
  const std::vector<MeshPlace> end{{ends.row(1), mesh_.triangleAt(to)}};
  if (begin.triangle == end[0].triangle) {
    return {{from, to}};
  }
  const std::vector<int> one(static_cast<std::size_t>(mesh_.vertexCount()), 1);
  const NearestSources distances(mesh_, end, one, {}, longest);
  std::vector<NearestSources::Entry> found;
  distances.find(begin, found);
  if (found.empty() || !(found[0].distance <= longest)) {
    return {};
  }
  Descent descent(mesh_, distances, from, begin, to, end[0]);
  const Way across = descent.go(true);
  if (!across.parts.empty() && across.length <= kAsExpected * found[0].distance) {
    return across.parts;
  }
  const Way along = descent.go(false);
  const bool is_along =
      across.parts.empty() || (!along.parts.empty() && along.length < across.length);
  return is_along ? along.parts : across.parts;
}

}  // namespace limitsurf
