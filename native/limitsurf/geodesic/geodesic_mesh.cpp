// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/geodesic_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "limitsurf/geodesic/curve_cuts.h"
#include "limitsurf/geodesic/delaunay_flips.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// Sets of corners, of which two are united at a time.
class CornerSets {
 public:
  explicit CornerSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int corner) {
    while (parent_[corner] != corner) {
      corner = parent_[corner] = parent_[parent_[corner]];
    }
    return corner;
  }
  void unite(int a, int b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
  }

 private:
  std::vector<int> parent_;
};

SurfaceTriangles dividedAlong(const GeodesicCuts& cuts, const LimitSurface& surface,
                              const std::vector<int>& levels, int threads,
                              const Progress& progress) {
  SurfaceTriangles triangles = surfaceTriangles(surface, levels, cuts.edges, threads, progress);
  cutAlongCurves(triangles, surface, levels, cuts.curves, threads);
  return triangles;
}

}  // namespace

GeodesicMesh::GeodesicMesh(const LimitSurface& surface, const std::vector<int>& levels,
                           const GeodesicCuts& cuts, int threads, const Progress& progress)
    : triangles_(dividedAlong(cuts, surface, levels, threads, progress)),
      cells_(surface, levels, triangles_) {
  hangTogether();
  listAround();
  listNeighbors();
}

int GeodesicMesh::triangleUnder(const Vector3& position, int triangle) const {
  double depth = -std::numeric_limits<double>::infinity();
  int best = triangle;
  while (triangle >= 0) {
    const std::array<double, 3> weights = weightsUnder(position, triangle);
    const auto least = std::min_element(weights.begin(), weights.end());
    if (!(*least > depth)) {  // false as well for a triangle without area
      break;
    }
    depth = *least;
    best = triangle;
    if (depth >= 0) {
      break;
    }
    const auto k = static_cast<std::size_t>(least - weights.begin());
    const std::array<int, 3>& vertices = this->triangle(triangle);
    triangle = beyond(triangle, vertices[(k + 1) % 3], vertices[(k + 2) % 3]);
  }
  return best;
}

std::array<double, 3> GeodesicMesh::weightsUnder(const Vector3& at, int triangle) const {
  const auto& [a, b, c] = this->triangle(triangle);
  const double unit = 1 / std::max(distance(a, b), distance(a, c));  // products stay in range
  const Vector3 to_b = (position(b) - position(a)) * unit,
                to_c = (position(c) - position(a)) * unit;
  const Vector3 to_place = (at - position(a)) * unit, normal = to_b.cross(to_c);
  const double scale = 1 / normal.squaredNorm();
  const double of_b = to_place.cross(to_c).dot(normal) * scale;
  const double of_c = to_b.cross(to_place).dot(normal) * scale;
  return {1 - of_b - of_c, of_b, of_c};
}

int GeodesicMesh::beyond(int triangle, int a, int b) const {
  if (trianglesAt(b).size() < trianglesAt(a).size()) {  // one of them may be a pole
    std::swap(a, b);
  }
  for (const int other : trianglesAt(a)) {
    const std::array<int, 3>& vertices = this->triangle(other);
    if (other != triangle && std::find(vertices.begin(), vertices.end(), b) != vertices.end()) {
      return other;
    }
  }
  return -1;
}

/// Replaces points by vertices: the corners that sides link around a point.
void GeodesicMesh::hangTogether() {
  struct Side {
    int other;      // its larger point
    int low, high;  // its corners, counted over all triangles, at the smaller and the larger point
  };
  InterruptionStride stride;
  const std::size_t count = 3 * triangleCount();
  const auto for_each_side = [&](const auto& body) {
    for (std::size_t triangle = 0; triangle < triangleCount(); ++triangle) {
      stride.step();
      const std::array<int, 3>& points = triangles_.vertices[triangle];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (triangles_.is_cut[triangle][k]) {
          continue;
        }
        const int here = static_cast<int>(3 * triangle + k);
        const int there = static_cast<int>(3 * triangle + next);
        if (points[k] < points[next]) {
          body(points[k], Side{points[next], here, there});
        } else {
          body(points[next], Side{points[k], there, here});
        }
      }
    }
  };
  // The sides at each smaller point, by their larger ones.
  std::vector<int> end(triangles_.points.size() + 1, 0);
  for_each_side([&](int point, const Side&) { ++end[point + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Side> sides(static_cast<std::size_t>(end.back()));
  for_each_side([&](int point, const Side& side) { sides[end[point]++] = side; });
  CornerSets sets(count);
  for (std::size_t point = 0, begin = 0; point < triangles_.points.size(); ++point) {
    stride.step();
    const auto last = static_cast<std::size_t>(end[point]);
    std::sort(sides.begin() + begin, sides.begin() + last, [](const Side& a, const Side& b) {
      return a.other != b.other ? a.other < b.other : a.low < b.low;
    });
    for (std::size_t i = begin + 1; i < last; ++i) {
      if (sides[i].other == sides[i - 1].other) {
        sets.unite(sides[i].low, sides[i - 1].low);
        sets.unite(sides[i].high, sides[i - 1].high);
      }
    }
    begin = last;
  }
  std::vector<Vector3> positions;
  std::vector<int> number(count, -1);
  for (std::size_t corner = 0; corner < count; ++corner) {
    stride.step();
    int& vertex = triangles_.vertices[corner / 3][corner % 3];
    int& of_set = number[sets.find(static_cast<int>(corner))];
    if (of_set < 0) {
      of_set = static_cast<int>(positions.size());
      positions.push_back(triangles_.points[vertex]);
    }
    vertex = of_set;
  }
  triangles_.points = std::move(positions);
}

void GeodesicMesh::listAround() {
  InterruptionStride stride;
  first_around_.assign(triangles_.points.size() + 1, 0);
  for (const auto& triangle : triangles_.vertices) {
    stride.step();
    for (const int vertex : triangle) {
      ++first_around_[vertex + 1];
    }
  }
  std::partial_sum(first_around_.begin(), first_around_.end(), first_around_.begin());
  around_.resize(3 * triangleCount());
  std::vector<int> end(first_around_.begin(), first_around_.end() - 1);
  for (std::size_t number = 0; number < triangleCount(); ++number) {
    stride.step();
    for (const int vertex : triangles_.vertices[number]) {
      around_[end[vertex]++] = static_cast<int>(number);
    }
  }
}

void GeodesicMesh::listNeighbors() {
  const std::vector<FlatTriangle> flipped = flippedTriangles(triangles_);
  struct Corner {
    int triangle, k;
  };
  InterruptionStride stride;
  std::vector<int> end(triangles_.points.size() + 1, 0);
  for (const FlatTriangle& triangle : flipped) {
    stride.step();
    for (const int vertex : triangle.vertices) {
      ++end[vertex + 1];
    }
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Corner> corners(3 * flipped.size());
  for (std::size_t number = 0; number < flipped.size(); ++number) {
    stride.step();
    for (int k = 0; k < 3; ++k) {
      corners[end[flipped[number].vertices[k]]++] = {static_cast<int>(number), k};
    }
  }
  wedges_.reserve(around_.size() + corners.size());
  first_wedge_.reserve(triangles_.points.size() + 1);
  first_wedge_.push_back(0);
  first_neighbor_.reserve(triangles_.points.size() + 1);
  neighbors_.reserve(around_.size() + around_.size() / 8 + corners.size());
  first_neighbor_.push_back(0);
  for (int vertex = 0; vertex < vertexCount(); ++vertex) {
    stride.step();
    const auto first = static_cast<std::size_t>(first_neighbor_.back());
    // Poles have many neighbors: each is looked for among the last ones, beside which it mostly is.
    // One that is listed twice does no harm.
    constexpr std::size_t kLookBack = 64;
    const auto number_of = [&](int other, double distance) {
      const std::size_t size = neighbors_.size();
      for (std::size_t i = size; i-- > std::max(first, size - std::min(size, kLookBack));) {
        if (neighbors_[i].vertex == other && neighbors_[i].distance == distance) {
          return static_cast<int>(i - first);
        }
      }
      neighbors_.push_back({other, distance});
      return static_cast<int>(size - first);
    };
    for (const int number : trianglesAt(vertex)) {
      const std::array<int, 3>& around = triangle(number);
      const int k = around[0] == vertex ? 0 : around[1] == vertex ? 1 : 2;
      const int b = around[(k + 1) % 3], c = around[(k + 2) % 3];
      const int b_number = number_of(b, distance(vertex, b));
      const int c_number = number_of(c, distance(vertex, c));
      wedges_.push_back({b_number, c_number, distance(b, c)});
    }
    for (int i = vertex == 0 ? 0 : end[vertex - 1]; i < end[vertex]; ++i) {
      const FlatTriangle& flat = flipped[corners[i].triangle];
      const std::size_t k = corners[i].k, next = (k + 1) % 3, last = (k + 2) % 3;
      const int b_number = number_of(flat.vertices[next], flat.sides[k]);
      const int c_number = number_of(flat.vertices[last], flat.sides[last]);
      wedges_.push_back({b_number, c_number, flat.sides[next]});
    }
    first_neighbor_.push_back(static_cast<int>(neighbors_.size()));
    first_wedge_.push_back(static_cast<int>(wedges_.size()));
  }
}

}  // namespace limitsurf
