// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_cell.h"

namespace limitsurf {

/// The inverse of the map on a cell on which its Jacobian hardly changes.
///
/// Let M be the inverse of the mean Jacobian and |M J - 1| <= q everywhere on the cell, in the
/// maximum norm; differences of control points bound it. Then the map is one-to-one, and Newton's
/// iteration, brought back into the cell after each step, comes closer to the point that is sought
/// by a factor of 2q / (1 - q) at least: it finds the point if it is there, and otherwise shows
/// that it is not.
class CellInverse {
 public:
  /// Whether the Jacobian changes so little; all else has a meaning only then. `tolerance`: what
  /// may be left of each coordinate.
  bool set(const UvCell& cell, const Point2& tolerance);

  /// A place in the cell, from its middle: -1/2 to 1/2.
  struct Place {
    Point2 x;
    Point2 ds, dt;  ///< the map's derivatives before the last step
    double determinant;
    /// Newton's last step, not brought back into the cell: a start for points nearby.
    Point2 beyond;
  };
  /// Whether the cell takes the value `target`, to the tolerance; out.x is where the search begins
  /// and ends.
  bool find(const Point2& target, Place& out) const;

  /// Where the linear part of the map takes that value.
  Point2 guess(const Point2& target) const;
  /// The map's derivatives at a place, from the cell's middle.
  void derivatives(const Point2& x, Point2& ds, Point2& dt) const;
  /// Farther than this from the cell's sides, the map's distance to them is more than four times
  /// the tolerance.
  double borderWidth() const { return border_width_; }

 private:
  static constexpr double kMostVariation = 1. / 8;
  static constexpr int kMostSteps = 32;

  void evaluate(const Point2& x, const Point2& target, Point2& rest, Point2& ds, Point2& dt) const;

  Point2 c_[16];      // coefficients of powers of s and t, from the middle: [4 t + s]
  Point2 m_s_, m_t_;  // the columns of M
  Point2 tolerance_;
  double curvature_;    // times a step squared: Newton's error in units of the tolerance
  double contraction_;  // of the distance that is left, in units of the step that was made
  double border_width_;
};

}  // namespace limitsurf
