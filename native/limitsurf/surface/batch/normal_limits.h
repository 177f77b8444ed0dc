// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// What du and dv must meet so that their cross product can be taken as the normal without looking
/// closer.
struct NormalLimits {
  /// The squared sine of the angle between du and dv.
  double sine_square = 0;
  /// |du x dv|^2 over |du|^2 + |dv|^2: far above the square of the rounding of du and dv.
  double square = 0;
};

}  // namespace limitsurf
