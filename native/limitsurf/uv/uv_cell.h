// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_plane.h"

namespace limitsurf {

/// A dyadic square of a patch's parameters, (s0, t0) to (s0 + size, t0 + size), and the map on it,
/// a bicubic polynomial in Bezier form.
struct UvCell {
  Point2 points[16];  ///< row by row: [4 t + s]
  double s0 = 0, t0 = 0, size = 1;

  Box2 box() const;
  /// The quarters of the cell, by de Casteljau's algorithm.
  void quarter(UvCell out[4]) const;
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
