// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/bspline_window.h"

namespace limitsurf {

/// The surface beside a semi-sharp edge on a regular quad on which nothing else is sharp: a patch
/// with a crease along one side.
///
/// Sdc's crease rule, its smooth rule and any blend of them are products of one rule along the
/// crease, a cubic B-spline's, and another across it. Across it, the point on the crease stays
/// where it is for n steps, as long as the sharpness is at least 1. In the next step the two rules
/// are blended according to the rest of the sharpness, and from then on the rule is that of a
/// B-spline. While the point stays, differences from it halve and the second difference beside it
/// shrinks to an eighth, so that n steps have a closed form. Farther from the crease the surface is
/// that beside an infinitely sharp edge. So the patch is bicubic in at most three strips: up to
/// 2^-(n + 1), 2^-n and 1 from the crease.
class SingleCrease {
 public:
  /// 0 < sharpness < 10.
  explicit SingleCrease(float sharpness);

  /// Weights at the distance t in [0, 1] from the crease, on four points: the one beyond the
  /// crease, the one on it, and the next two inwards. If `cut`, the last of them is the linear
  /// continuation of its neighbours.
  CubicWeights weights(double t, bool cut) const;

  /// The borders of the strips, from 0 to 1.
  static constexpr int kMostStrips = 3;
  int strips(double borders[kMostStrips + 1]) const;

 private:
  double size_ = 1;   // 2^-n
  double remainder_;  // of the sharpness after n steps, below 1
};

}  // namespace limitsurf
