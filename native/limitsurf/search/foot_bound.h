// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// What is known of a patch, for all searching points, that lets first-order conditions prove a
/// closest point. It is computed once for a patch.
///
/// Let x and y be points of the patch, d the difference of their parameters, q the searching point,
/// and g half the derivative of the squared distance at x. With J and P'' as means of the
/// derivatives between x and y, y - x = J d = J(x) d + P''(d, d) / 2, so that
///
///   |y - q|^2 = |x - q|^2 + 2 (y - x) . (x - q) + |y - x|^2
///            >= |x - q|^2 + 2 g . d + (x - q) . P''(d, d) + m^2 |d|^2
///
/// if |J d| >= m |d| on the whole patch. Where the last two summands together are not negative, the
/// squared distance lies above its tangent plane at x, as it does where it is convex: where x meets
/// the first-order conditions of a minimum, no point of the patch is closer.
///
/// Parameters a and b with s = ea a + skew b and t = eb b are chosen so that the mean derivative is
/// orthonormal; then m is 1 less the largest deviation of J.
struct FootBound {
  /// Nothing is known.
  FootBound() = default;
  explicit FootBound(const BezierPatch& patch);

  /// The square of m; 0 if the bound proves nothing.
  float stretch = 0;
  float ea = 0, eb = 0, skew = 0;
  /// If |x - q| is at most this, the two summands are never negative: m^2 through a bound of
  /// |P''(d, d)| / |d|^2.
  float radius = 0;

  /// The same for one direction and any distance: whether the summands are not negative if x - q
  /// has that `distance` and a direction along which the patch's Bezier points lie at z.
  bool holds(const double z[16], double distance) const;
};

}  // namespace limitsurf
