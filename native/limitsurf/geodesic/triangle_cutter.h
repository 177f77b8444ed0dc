// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "limitsurf/geodesic/surface_triangles.h"
#include "limitsurf/geodesic/triangles_around.h"

namespace limitsurf {

/// Divides triangles so that given places are points of them, and cuts them along plane sections
/// between such points.
class TriangleCutter {
 public:
  explicit TriangleCutter(SurfaceTriangles& triangles);

  /// Makes a location a point of the triangles. `triangle` is the one in which it lay before any
  /// was divided. A point or side that is closer than `tolerance`, as a share of the triangle's
  /// height, is taken for it. Returns the point; -1 where there is no triangle (-1).
  int insert(int triangle, const Location& at, double tolerance);

  /// Cuts the triangles from one of their points to another, along the section by the plane that
  /// contains both and the normal. Where that leads elsewhere, a short way on sides of triangles is
  /// cut; where there is none either, nothing more. Does nothing from or to the point -1.
  void connect(int from, int to);

  /// Frees the memory, which can be interrupted, other than by the destructor. Nothing can be cut
  /// afterwards.
  void release();

 private:
  struct Crossing {
    int a, b;      // the points of the side that is crossed
    double share;  // of the way from a to b
  };

  int splitSide(int a, int b, double share);
  int splitTriangle(int triangle, const std::array<double, 3>& weights);
  int addTriangle(int like);
  void place(int triangle, int corner, int point, SurfaceTriangles::Corner at);
  int cornerOf(int triangle, int point) const;
  double distance(int a, int b) const;
  bool isSide(int a, int b) const;
  void cutSide(int a, int b);
  Vector3 normalAround(int point, const Vector3& like) const;
  std::optional<Crossing> nextCrossing(int at, int to, const Vector3& across) const;
  void cutShortestWay(int from, int to);

  SurfaceTriangles& triangles_;
  TrianglesAround around_;
  // of triangles that were divided: all their pieces; and of pieces: what they are pieces of
  std::unordered_map<int, std::vector<int>> pieces_;
  std::size_t whole_count_;
  std::vector<int> origin_;
};

}  // namespace limitsurf
