// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>

#include "limitsurf/surface/cubic_weights.h"

namespace limitsurf {

/// A point or vector padded to four doubles, so that compilers use whole registers.
using Padded = Eigen::Array4d;

/// Position and derivatives at one location.
///
/// The position is anchor + offset, where the anchor is near, so that derivatives are differences of
/// small numbers. Second derivatives are to be multiplied by 2^exponent: close to an extraordinary
/// vertex they alone leave the range of double.
struct Jet {
  Padded anchor, offset, du, dv, duu, duv, dvv;
  int exponent = 0;

  /// From the frame of a quad turned so that its corner c comes first to the quad's own.
  void turn(int c) {
    if (c == 1 || c == 3) {
      std::swap(du, dv);
      std::swap(duu, dvv);
      duv = -duv;
    }
    if (c == 1 || c == 2) {
      du = -du;
    }
    if (c == 2 || c == 3) {
      dv = -dv;
    }
  }

  /// From the parameters of a child to those of its parent.
  void zoomOut() {
    du *= 2;
    dv *= 2;
    exponent += 2;
  }
};

/// (u, v) of a quad as seen from its corner c: that corner is (0, 0), the next one (1, 0).
inline void turnParameters(int c, double& u, double& v) {
  for (const double u0 = u, v0 = v; c != 0;) {
    if (c == 1) {
      u = v0;
      v = 1 - u0;
    } else if (c == 2) {
      u = 1 - u0;
      v = 1 - v0;
    } else {
      u = 1 - v0;
      v = u0;
    }
    return;
  }
}

/// The bicubic patch of a 4 x 4 window of control points, rows `stride` points apart.
template <int Order>
void evaluateWindow(const Padded* points, int stride, const CubicWeights& u, const CubicWeights& v,
                    Jet& jet) {
  Padded row[4], row_du[4], row_duu[4];
  for (int y = 0; y < 4; ++y, points += stride) {
    row[y] = u.value[0] * points[0] + u.value[1] * points[1] + u.value[2] * points[2] +
             u.value[3] * points[3];
    if (Order >= 1) {
      row_du[y] = u.first[0] * points[0] + u.first[1] * points[1] + u.first[2] * points[2] +
                  u.first[3] * points[3];
    }
    if (Order >= 2) {
      row_duu[y] = u.second[0] * points[0] + u.second[1] * points[1] + u.second[2] * points[2] +
                   u.second[3] * points[3];
    }
  }
  const auto across = [](const double w[4], const Padded r[4]) -> Padded {
    return w[0] * r[0] + w[1] * r[1] + w[2] * r[2] + w[3] * r[3];
  };
  jet.offset = across(v.value, row);
  if (Order >= 1) {
    jet.du = across(v.value, row_du);
    jet.dv = across(v.first, row);
  }
  if (Order >= 2) {
    jet.duu = across(v.value, row_duu);
    jet.duv = across(v.first, row_du);
    jet.dvv = across(v.second, row);
  }
}

}  // namespace limitsurf
