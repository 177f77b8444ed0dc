// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/geodesic/delaunay_flips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "limitsurf/geodesic/unfolding.h"
#include "limitsurf/interruption_point.h"

namespace limitsurf {
namespace {

/// A side is flipped if the cotangents of the two angles opposite to it have a sum below this. With
/// 0 the result would be Delaunay. This one leaves alone what is shaped well enough for distances
/// to spread: 90 and 116 degrees, for example.
constexpr double kLeastCotangents = -0.5;
/// Sides whose lengths have a larger ratio leave no correct digits to an unfolded length.
constexpr double kLargestRatio = 1e6;
/// Flips for each triangle. The number that is needed grows with how much faces are sheared.
constexpr std::size_t kMostFlips = 32;
constexpr int kNone = -1;

/// Of the angle at the apex of a triangle.
double cotangent(const Apex& apex, double base) {
  const double cosine = apex.y * apex.y - apex.x * (base - apex.x), sine = base * apex.y;
  return sine > 0 ? cosine / sine : std::copysign(std::numeric_limits<double>::infinity(), cosine);
}

/// Triangles that are glued side to side. Side k of a triangle goes from its corner k to the next.
class GluedTriangles {
 public:
  explicit GluedTriangles(const SurfaceTriangles& triangles);

  void flipAll();
  std::vector<FlatTriangle> flipped() const;

 private:
  void glue(const SurfaceTriangles& triangles);
  /// Glues a side to another one, or to none.
  void link(int side, int other) {
    across_[side] = other;
    if (other != kNone) {
      across_[other] = side;
    }
  }
  /// Flips a side, numbered 3 * triangle + k, if its angles ask for it.
  bool flip(int side);
  void wait(int side) {
    if (across_[side] != kNone && !is_waiting_[side / 3][side % 3]) {
      is_waiting_[side / 3][side % 3] = true;
      waiting_.push_back(side);
    }
  }
  static int next(int side) { return side % 3 == 2 ? side - 2 : side + 1; }
  int start(int side) const { return triangles_[side / 3].vertices[side % 3]; }
  double length(int side) const { return triangles_[side / 3].sides[side % 3]; }

  std::vector<FlatTriangle> triangles_;
  std::vector<int> across_;  // per side: the same side of the other triangle
  std::vector<bool> is_flipped_;
  std::vector<std::array<bool, 3>> is_waiting_;
  std::vector<int> waiting_;
};

GluedTriangles::GluedTriangles(const SurfaceTriangles& triangles)
    : across_(3 * triangles.vertices.size(), kNone),
      is_flipped_(triangles.vertices.size()),
      is_waiting_(triangles.vertices.size()) {
  triangles_.reserve(triangles.vertices.size());
  InterruptionStride stride;
  for (const std::array<int, 3>& vertices : triangles.vertices) {
    stride.step();
    FlatTriangle& made = triangles_.emplace_back();
    made.vertices = vertices;
    for (std::size_t k = 0; k < 3; ++k) {
      made.sides[k] =
          (triangles.points[vertices[k]] - triangles.points[vertices[(k + 1) % 3]]).norm();
    }
  }
  glue(triangles);
}

void GluedTriangles::glue(const SurfaceTriangles& triangles) {
  struct Side {
    int other;  // its larger vertex
    int number;
  };
  InterruptionStride stride;
  const auto for_each_side = [&](const auto& body) {
    for (int side = 0; side < static_cast<int>(across_.size()); ++side) {
      stride.step();
      if (!triangles.is_cut[side / 3][side % 3]) {
        const auto [low, high] = std::minmax({start(side), start(next(side))});
        body(low, Side{high, side});
      }
    }
  };
  std::vector<int> end(triangles.points.size() + 1, 0);
  for_each_side([&](int low, const Side&) { ++end[low + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Side> sides(static_cast<std::size_t>(end.back()));
  for_each_side([&](int low, const Side& side) { sides[end[low]++] = side; });
  std::size_t begin = 0;
  for (std::size_t vertex = 0; vertex < triangles.points.size(); ++vertex) {
    stride.step();
    const auto last = static_cast<std::size_t>(end[vertex]);
    std::sort(sides.begin() + begin, sides.begin() + last, [](const Side& a, const Side& b) {
      return a.other != b.other ? a.other < b.other : a.number < b.number;
    });
    while (begin < last) {
      std::size_t count = 1;
      while (begin + count < last && sides[begin + count].other == sides[begin].other) {
        ++count;
      }
      const int a = sides[begin].number;
      // Triangles that are wound differently, and more than two, stay as they are.
      if (count == 2 && start(a) != start(sides[begin + 1].number)) {
        link(a, sides[begin + 1].number);
      }
      begin += count;
    }
  }
}

bool GluedTriangles::flip(int side) {
  const int other = across_[side];
  if (other == kNone || side / 3 == other / 3) {
    return false;
  }
  const int bc = next(side), ca = next(bc), ad = next(other), db = next(ad);
  const double ab = length(side);
  const auto [least, most] = std::minmax({ab, length(bc), length(ca), length(ad), length(db)});
  const int a = start(side), b = start(bc), c = start(ca), d = start(db);
  if (c == d || !(least > 0 && most <= kLargestRatio * least)) {
    return false;
  }
  const Apex above(ab, length(ca), length(bc)), below(ab, length(ad), length(db));
  if (!(cotangent(above, ab) + cotangent(below, ab) < kLeastCotangents)) {
    return false;
  }
  const double cd = std::hypot(above.x - below.x, above.y + below.y);
  const FlatTriangle first{{a, d, c}, {length(ad), cd, length(ca)}};
  const FlatTriangle second{{d, b, c}, {length(db), length(bc), cd}};
  const int beyond[] = {across_[ad], across_[ca], across_[db], across_[bc]};
  const int t = 3 * (side / 3), s = 3 * (other / 3);
  triangles_[side / 3] = first;
  triangles_[other / 3] = second;
  is_flipped_[side / 3] = is_flipped_[other / 3] = true;
  // Two of the four outer sides may be one and the same.
  const int from[] = {ad, ca, db, bc}, to[] = {t, t + 2, s, s + 1};
  const auto moved = [&](int of) {
    for (int i = 0; i < 4; ++i) {
      if (of == from[i]) {
        return to[i];
      }
    }
    return of;
  };
  for (int i = 0; i < 4; ++i) {
    link(to[i], moved(beyond[i]));
  }
  link(t + 1, s + 2);
  for (const int outer : to) {
    wait(outer);
  }
  return true;
}

void GluedTriangles::flipAll() {
  InterruptionStride stride;
  for (int side = 0; side < static_cast<int>(across_.size()); ++side) {
    if (side < across_[side]) {
      wait(side);
    }
  }
  std::reverse(waiting_.begin(), waiting_.end());
  for (std::size_t left = kMostFlips * triangles_.size(); left > 0 && !waiting_.empty();) {
    stride.step();
    const int side = waiting_.back();
    waiting_.pop_back();
    is_waiting_[side / 3][side % 3] = false;
    left -= flip(side) ? 1 : 0;
  }
}

std::vector<FlatTriangle> GluedTriangles::flipped() const {
  std::vector<FlatTriangle> made;
  for (std::size_t number = 0; number < triangles_.size(); ++number) {
    if (is_flipped_[number]) {
      made.push_back(triangles_[number]);
    }
  }
  return made;
}

}  // namespace

std::vector<FlatTriangle> flippedTriangles(const SurfaceTriangles& triangles) {
  GluedTriangles glued(triangles);
  glued.flipAll();
  return glued.flipped();
}

}  // namespace limitsurf
