// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "limitsurf/bernstein.h"
#include "limitsurf/search/search_kernels.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The squared distance of a bicubic patch from a point, less that of the point from a place near
/// the patch, as a polynomial of degree 6. For points far away the difference keeps the digits that
/// tell places of the patch apart.
///
/// The polynomial has Bezier form, so its coefficients bound it. They do so far better than a box
/// around the patch: where the patch bends around the point they are nearly equal.
class SquaredDistance {
 public:
  SquaredDistance() = default;
  /// `points` are the Bezier points of the patch, `away` is the point, both relative to the place.
  SquaredDistance(const SearchKernels& kernels, const BezierPatch::Point points[16],
                  const BezierPatch::Point& away);

  double least() const { return least_; }
  /// The size of the numbers that the coefficients are sums of: their rounding is relative to it.
  double magnitude() const { return std::max({largest_, -least_, summands_}); }
  /// The value at a corner: i and j are 0 or 1.
  double corner(int i, int j) const { return f_.at(6 * i, 6 * j); }
  /// Whether the polynomial falls (-1) or rises (1) along all of a side (kSideS0, ...), with the
  /// other parameter, by more than rounding; 0 if unknown.
  int slopeAlong(unsigned side) const;
  /// How a square is divided: into quarters, or into halves along one parameter.
  enum class Division { both, s, t };
  /// The polynomial on the parts: out[0] at (0, 0), out[1] at (1/2, 0), out[2] at (0, 1/2), out[3]
  /// at (1/2, 1/2). Where only s is divided, out[2] and out[3] are left as they are; where only t
  /// is, out[1] and out[3].
  void divide(Division along, SquaredDistance out[4]) const;

  /// A guess of the place of the minimum: that of the least coefficient.
  void guess(double& s, double& t) const;

  /// What the coefficients prove about the minimum.
  struct Shape {
    /// The minimum lies on the side at the low (-1) or the high (1) end of s or t; 0 if unknown.
    int s_side = 0, t_side = 0;
    /// The polynomial falls towards that side everywhere, by more than rounding.
    bool s_strictly = false, t_strictly = false;
    /// The sizes of the second differences of the coefficients along s and along t.
    double s_bend = 0, t_bend = 0;
    /// A point of the square, or of the sides named above, that meets the first-order conditions of
    /// a minimum exceeds the true minimum by `slack` at most.
    bool convex = false;
  };
  Shape shape(double slack) const;

  /// Whether no minimum lies inside the square, since the Hessian is positive at none of its
  /// points.
  bool isNowhereConvex() const;

 private:
  /// Sets the bounds, and what this has in common with a part of it.
  void finish(const SquaredDistance& whole);
  /// Whether the smaller eigenvalue of the Hessian is at least -slack everywhere.
  static bool isConvex(const DifferenceBounds& d, double slack);

  const SearchKernels* kernels_;
  Bernstein<6> f_;
  double least_, largest_;  // of the coefficients
  /// The largest |P| (|P| + 2 |away|) of a point P, or 0 for points that are not far away: there
  /// nothing cancels.
  double summands_ = 0;
};

}  // namespace limitsurf
