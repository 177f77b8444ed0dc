// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/bspline_window.h"

namespace limitsurf {

/// The surface beside a semi-sharp edge where nothing else is sharp and all is regular: a patch
/// with a crease along one side.
///
/// Sdc's crease rule, its smooth rule and any blend of them are products of one rule along the
/// crease, a cubic B-spline's, and another across it. Across, the point on the crease stays for as
/// many steps n as the sharpness is 1 or more, is blended by what is then left of the sharpness for
/// one step, and is a B-spline's ever after. While it stays, differences from it halve and the
/// second difference beside it shrinks to an eighth, so that n steps have a closed form; and what
/// has left the crease behind is the surface beside an infinitely sharp one. So the patch is
/// bicubic in at most three strips: up to 2^-(n + 1), 2^-n and 1 from the crease.
class SingleCrease {
 public:
  /// 0 < sharpness < 10.
  explicit SingleCrease(float sharpness);

  /// Weights at t in [0, 1] across of the points beyond the crease, on it, and the two inwards; the
  /// last is the linear continuation of its neighbours if `cut`.
  CubicWeights weights(double t, bool cut) const;

  /// The borders of the strips, from 0 to 1.
  static constexpr int kMostStrips = 3;
  int strips(double borders[kMostStrips + 1]) const;

 private:
  double size_ = 1;   // 2^-n
  double remainder_;  // of the sharpness after n steps, below 1
};

}  // namespace limitsurf
