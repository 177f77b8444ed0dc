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
  // a lies at the origin and b at (ab, 0); the source is below them, c above
  const double inverse = 1 / ab;
  const double source_x = ((to_a - to_b) * (to_a + to_b) * inverse + ab) / 2;
  const double x = ((sides.ac - sides.bc) * (sides.ac + sides.bc) * inverse + ab) / 2;
  const double source_y = std::sqrt(std::max(0., (to_a - source_x) * (to_a + source_x)));
  const double y = std::sqrt(std::max(0., (sides.ac - x) * (sides.ac + x)));
  const double height = source_y + y;
  if (!(height > 0)) {
    return {};
  }
  const double crossing = source_x + (x - source_x) * (source_y / height);
  if (crossing < 0 || crossing > ab) {
    return {};
  }
  const double beside = x - source_x;
  return {std::sqrt(beside * beside + height * height), std::clamp(crossing * inverse, 0., 1.)};
}

/// The distance of unfoldedWay().
inline double unfoldedDistance(double to_a, double to_b, const TriangleSides& sides) {
  return unfoldedWay(to_a, to_b, sides).distance;
}

}  // namespace limitsurf
