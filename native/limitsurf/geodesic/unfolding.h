// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace limitsurf {

/// The three sides of a triangle a, b, c.
struct TriangleSides {
  double ab, ac, bc;
};

/// The third corner of a triangle whose side of length `base`, above 0, lies on the x axis, from
/// the origin on. Its y is not negative.
struct Apex {
  double x, y;

  Apex(double base, double to_start, double to_end)
      : x(((to_start - to_end) * (to_start + to_end) * (1 / base) + base) / 2),
        y(std::sqrt(std::max(0., (to_start - x) * (to_start + x)))) {}
};

/// A straight way across the side ab of a triangle.
struct UnfoldedWay {
  double distance = std::numeric_limits<double>::infinity();
  double share = 0;  ///< of ab, from a to the point where the way crosses it
};

/// The way to c from a source beyond the side ab of a triangle, of which the distances of a and b
/// are known: the triangle and the source are laid into one plane. The distance is infinite where
/// the straight way from there to c passes beside the side. On a flat surface it is exact.
inline UnfoldedWay unfoldedWay(double to_a, double to_b, const TriangleSides& sides) {
  const double ab = sides.ab;
  if (!(ab > 0)) {
    return {};
  }
  // a lies at the origin and b at (ab, 0); c is above them, and the source as far below as its y
  const Apex source(ab, to_a, to_b), c(ab, sides.ac, sides.bc);
  const double height = source.y + c.y;
  if (!(height > 0)) {
    return {};
  }
  const double crossing = source.x + (c.x - source.x) * (source.y / height);
  if (crossing < 0 || crossing > ab) {
    return {};
  }
  const double beside = c.x - source.x;
  return {std::sqrt(beside * beside + height * height), std::clamp(crossing * (1 / ab), 0., 1.)};
}

/// The distance of unfoldedWay().
inline double unfoldedDistance(double to_a, double to_b, const TriangleSides& sides) {
  return unfoldedWay(to_a, to_b, sides).distance;
}

}  // namespace limitsurf
