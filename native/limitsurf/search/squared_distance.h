// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/bernstein.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The squared distance of a bicubic patch from a point, as a polynomial of degree 6.
///
/// Its coefficients bound it far better than a box around the patch does: they are nearly equal
/// where the patch bends around the point.
class SquaredDistance {
 public:
  SquaredDistance() = default;
  /// `points`: the patch's Bezier points less the point.
  explicit SquaredDistance(const BezierPatch::Point points[16]);

  double least() const { return f_.least(); }
  double largest() const { return f_.largest(); }
  /// At a corner: i, j = 0 or 1.
  double corner(int i, int j) const { return f_.at(6 * i, 6 * j); }
  void quarter(SquaredDistance out[4]) const;

  /// Where the coefficients suggest that the minimum is.
  void guess(double& s, double& t) const;

  /// What the coefficients prove about the minimum.
  struct Shape {
    /// It lies on the side at the low (-1) or high (1) end of s or t; 0: who knows.
    int s_side = 0, t_side = 0;
    /// It falls towards that side everywhere, by more than rounding.
    bool s_strictly = false, t_strictly = false;
    /// A point of the square, or of the sides named, that is the minimum to first order exceeds the
    /// true one by `slack` at most.
    bool convex = false;
  };
  Shape shape(double slack) const;

  /// Whether there is no minimum inside the square: at none of its points the Hessian is positive.
  bool isNowhereConvex() const;

 private:
  /// Whether the Hessian's lesser eigenvalue is at least -slack.
  bool isConvex(double slack) const;

  Bernstein<6> f_;
};

}  // namespace limitsurf
