// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_plane.h"

namespace limitsurf {

/// A square of a patch's parameters, (s0, t0) to (s0 + size, t0 + size), and the map on it, a
/// bicubic polynomial in Bezier form.
struct UvCell {
  Point2 points[16];  ///< row by row: [4 t + s]
  double s0 = 0, t0 = 0, size = 1;

  Box2 box() const;
  /// Its quarters. De Casteljau.
  void quarter(UvCell out[4]) const;
  /// Value and derivatives at (s, t) of the cell, 0 to 1.
  void evaluate(double s, double t, Point2& value, Point2& ds, Point2& dt) const;
};

/// Bernstein coefficients, 6 x 6, of the Jacobian determinant on a cell: they bound it.
struct JacobianBounds {
  explicit JacobianBounds(const UvCell& cell);
  double least, largest;
};

}  // namespace limitsurf
