// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_plane.h"

namespace limitsurf {

/// A dyadic rectangle of a patch's parameters, from `low` to low + size, and the map on it, a
/// bicubic polynomial in Bezier form.
struct UvCell {
  Point2 points[16];  ///< row by row: [4 t + s]
  Point2 low = Point2::Zero(), size = Point2::Ones();

  Box2 box() const;
  /// The quarters of the cell, by de Casteljau's algorithm.
  void quarter(UvCell out[4]) const;
  /// The halves of the cell, of half its size along s (0) or t (1).
  void halve(int direction, UvCell out[2]) const;
  /// Value and derivatives at (s, t), which run from 0 to 1 on the cell.
  void evaluate(double s, double t, Point2& value, Point2& ds, Point2& dt) const;
};

/// Bounds on the Jacobian determinant on a cell: the least and the largest of its 6 x 6 Bernstein
/// coefficients.
struct JacobianBounds {
  explicit JacobianBounds(const UvCell& cell);
  double least, largest;
};

}  // namespace limitsurf
