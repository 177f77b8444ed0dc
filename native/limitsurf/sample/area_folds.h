// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// What is known of the folds of a bicubic patch on a square of its parameters: whether ds x dt can
/// turn over within the square, so that its length has kinks that all points of a quadrature may
/// miss.
class AreaFolds {
 public:
  /// The coordinates of the patch's 16 control points, axis by axis.
  using Points = double[3][16];

  explicit AreaFolds(const Points& points);

  /// Whether (ds x dt) n > 0 everywhere, n the normal in the middle. May be false where it is so.
  bool isUpright() const;

  struct Parts {
    double signed_area;  ///< the integral of (ds x dt) n, n a unit vector
    double turned;       ///< at least the integral of its negative part, with its sign changed
  };
  Parts parts() const;

 private:
  double ds_[3][4][3], dt_[3][3][4];  // Bezier points of the derivatives
};

}  // namespace limitsurf
