// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/uv_cell.h"

namespace limitsurf {

/// The place in a cell whose image is nearest to a point, by the Levenberg-Marquardt iteration.
/// Distances are counted in tolerances, which may differ between the coordinates.
///
/// A step goes to the place where the linearised distance is least on the square of parameters. It
/// is not a step in the plane that is cut off at the sides: where du and dv are nearly parallel,
/// such a step leads away from the point along one of them, and the iteration would end beside a
/// side.
class CellNearest {
 public:
  /// `start` is a place in the cell, in coordinates from 0 to 1.
  CellNearest(const UvCell& cell, const Point2& target, const Point2& tolerance,
              const Point2& start);

  const Point2& at() const { return at_; }
  /// Whether the image of the place is the point, up to the tolerance.
  bool isReached() const { return (rest_.abs() <= 1).all(); }
  /// The Jacobian determinant there.
  double determinant() const { return cross(ds_ * tolerance_, dt_ * tolerance_); }

 private:
  /// The step from the present place, by the linearised map with the given damping.
  Point2 step(double damping) const;
  void evaluate(const Point2& at, Point2& rest, Point2& ds, Point2& dt) const;

  const UvCell& cell_;
  const Point2 target_, tolerance_;
  Point2 at_;
  // What the value at the place leaves of the point, and the derivatives, in tolerances.
  Point2 rest_, ds_, dt_;
};

}  // namespace limitsurf
