// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/uv/row_inverse.h"
#include "limitsurf/uv/uv_cell.h"

namespace limitsurf {

/// The inverse of the map on a cell on which its Jacobian matrix changes little.
///
/// Let M be the inverse of the mean Jacobian J, and |M J - 1| <= q everywhere on the cell, in the
/// maximum norm; differences of control points give q. Then the map is one-to-one, and Newton's
/// iteration, projected back into the cell after each step, reduces the distance from the solution
/// by a factor of 2q / (1 - q) or better. It finds the solution if the cell has one, and otherwise
/// proves that there is none. RowInverse iterates, from the numbers that are set here.
///
/// The cell also has points that its image reaches only up to the tolerance. Their solutions may
/// lie far beyond a side if du and dv are nearly parallel, farther than Newton's steps are long. So
/// a point is given up only if its solution is proved to be more than `reach` beyond the side, as
/// far as the tolerance can take it; what is neither found nor given up is doubtful.
class CellInverse {
 public:
  /// Sets the cell, and returns whether its Jacobian changes little enough; all other members
  /// require that. `tolerance` is the error allowed in each coordinate.
  bool set(const UvCell& cell, const Point2& tolerance);

  const CellNumbers& numbers() const { return numbers_; }
  /// The derivatives of the map at a place, in coordinates from -1/2 to 1/2 about the middle.
  void derivatives(const Point2& x, Point2& ds, Point2& dt) const;
  /// The image of a place farther than this from the cell's sides is more than four tolerances away
  /// from the images of the sides.
  double borderWidth() const { return border_width_; }

 private:
  /// The largest q. Each step then reduces the error by a factor of 2/7 or better, so that
  /// RowInverse's steps exhaust the digits of a double.
  static constexpr double kMostVariation = 1. / 8;

  /// q, from the control points of the derivatives along s and t; needs M.
  double variationOf(const Point2 ds[12], const Point2 dt[12]) const;
  /// Sets what depends on the tolerance, and returns how long a vector of the tolerance is that M
  /// has taken to the cell; `second` bounds the second derivatives. Needs M.
  double setTolerance(const Point2& tolerance, const Point2& second);
  /// Sets the coefficients of powers from the cell's Bezier points.
  void setPowers(const Point2* points);
  Point2 coefficient(int i) const {
    return {numbers_.coefficients[0][i], numbers_.coefficients[1][i]};
  }

  CellNumbers numbers_;
  double border_width_;
};

}  // namespace limitsurf
