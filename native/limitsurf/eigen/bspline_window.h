// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/eigen/derivative_nets.h"

namespace limitsurf {

#include "limitsurf/eigen/bspline_formulas.inl.h"

using CubicWeights = BSplineWeights<double>;

/// The same for a window whose rows are `stride` points apart.
template <int Order, typename Point>
void evaluateWindow(const Point* window, int stride, const CubicWeights& u, const CubicWeights& v,
                    PatchValues<Point>& out) {
  evaluatePatch<Order, Point>([=](int x, int y) -> const Point& { return window[y * stride + x]; },
                              u, v, out);
}

}  // namespace limitsurf
