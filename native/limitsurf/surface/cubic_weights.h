// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// Weights of four uniform cubic B-spline control points at t in [0, 1], with derivatives.
///
/// At a boundary the missing first (low) or last (high) point is the linear continuation of the two
/// next to it (paper, figure 2: p0 = 2 p1 - p2). It is folded into their weights in closed form, so
/// that at the boundary itself the inner points weigh exactly nothing.
struct CubicWeights {
  double value[4], first[4], second[4];

  CubicWeights(double t, bool low, bool high) {
    const double s = 1 - t, sixth = 1. / 6;
    if (low && high) {
      set(value, 0, s, t, 0);
      set(first, 0, -1, 1, 0);
      set(second, 0, 0, 0, 0);
    } else if (low) {
      const double t3 = t * t * t;
      set(value, 0, 1 - t + t3 * sixth, t - t3 / 3, t3 * sixth);
      set(first, 0, -1 + t * t / 2, 1 - t * t, t * t / 2);
      set(second, 0, t, -2 * t, t);
    } else if (high) {
      const double s3 = s * s * s;
      set(value, s3 * sixth, s - s3 / 3, 1 - s + s3 * sixth, 0);
      set(first, -s * s / 2, -1 + s * s, 1 - s * s / 2, 0);
      set(second, s, -2 * s, s, 0);
    } else {
      set(value, s * s * s * sixth, (4 + t * t * (3 * t - 6)) * sixth,
          (4 + s * s * (3 * s - 6)) * sixth, t * t * t * sixth);
      set(first, -s * s / 2, t * (1.5 * t - 2), -s * (1.5 * s - 2), t * t / 2);
      set(second, s, 3 * t - 2, 3 * s - 2, t);
    }
  }

 private:
  static void set(double out[4], double a, double b, double c, double d) {
    out[0] = a;
    out[1] = b;
    out[2] = c;
    out[3] = d;
  }
};

}  // namespace limitsurf
