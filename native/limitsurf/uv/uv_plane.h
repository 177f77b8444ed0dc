// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace limitsurf {

/// A point or vector in the plane of a UV map.
using Point2 = Eigen::Array2d;

inline double cross(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// An axis-aligned box in the plane. It is empty at first.
struct Box2 {
  Point2 low = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 high = Point2::Constant(-std::numeric_limits<double>::infinity());

  void include(const Point2& point) {
    low = low.min(point);
    high = high.max(point);
  }
  Box2 grown(const Point2& by) const { return {low - by, high + by}; }
};

/// The points with integer coordinates in a rectangle, its borders included: the centres of texels.
struct Lattice {
  int x0, y0, x1, y1;

  bool empty() const { return x0 > x1 || y0 > y1; }
  /// The points that lie in a box as well; none if a coordinate is NaN.
  Lattice within(const Box2& box) const {
    return {notBelow(box.low[0], x0, x1), notBelow(box.low[1], y0, y1),
            notAbove(box.high[0], x0, x1), notAbove(box.high[1], y0, y1)};
  }

 private:
  static int notBelow(double low, int first, int last) {
    return low <= first ? first : low <= last ? static_cast<int>(std::ceil(low)) : last + 1;
  }
  static int notAbove(double high, int first, int last) {
    return high >= last ? last : high >= first ? static_cast<int>(std::floor(high)) : first - 1;
  }
};

/// The transformation from map coordinates to those of a lattice.
struct PlaneFrame {
  Point2 origin;  ///< in map coordinates
  Point2 scale;
  double shift;  ///< added to both coordinates after scaling

  Point2 at(const Point2& in_map) const { return (in_map - origin) * scale + shift; }
  Box2 at(const Box2& in_map) const { return {at(in_map.low), at(in_map.high)}; }
};

}  // namespace limitsurf
