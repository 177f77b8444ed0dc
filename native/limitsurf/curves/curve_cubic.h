// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A part of a limit curve on which it is one cubic polynomial, in Bezier form.
struct CurveCubic {
  using Point = BezierPatch::Point;

  Point anchor;       ///< near the curve, so that the points keep the digits of short parts
  Point points[4];    ///< Bezier control points less the anchor
  double begin, end;  ///< the fractions of the edge between which it runs

  /// The same curve, run through in the opposite direction.
  CurveCubic reversed() const {
    return {anchor, {points[3], points[2], points[1], points[0]}, 1 - end, 1 - begin};
  }

  Vector3 position(double t) const {
    Point value, first, second;
    bezier::cubic<0>(points[0], points[1], points[2], points[3], t, value, first, second);
    return (anchor + value).head<3>().matrix();
  }

  Point derivative(double t) const {
    const Point ab = points[1] - points[0], bc = points[2] - points[1], cd = points[3] - points[2];
    const Point abc = ab + t * (bc - ab), bcd = bc + t * (cd - bc);
    return 3 * (abc + t * (bcd - abc));
  }

  /// The length of the derivative: the speed with which t runs along the curve.
  double speed(double t) const {
    const Point d = derivative(t);
    return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  }

  /// The length of the part between two parameters, by Gauss-Legendre quadrature on 10 points.
  double quadrature(double from, double to) const;

  /// The parameters inside (0, 1), in ascending order, at which the speed has a minimum far below
  /// its largest value: those of cusps and of the sharpest turns. Between them it has no kinks.
  std::vector<double> turns() const;
};

}  // namespace limitsurf
