// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "limitsurf/precision/double_double.h"

// Elementary functions of double-doubles. They call no function of the system but sqrt() and
// round(), which are exact up to rounding, so that their digits are the same everywhere.

namespace limitsurf {

template <typename Scalar>
struct SineCosine {
  Scalar sin, cos;
};

/// sin(x) and cos(x) for |x| <= 1000, with absolute errors of at most 2e-31 (1 + |x|). Where |x| is
/// at most pi/32, the relative error of sin(x) is at most 2e-31.
SineCosine<DoubleDouble> sineCosine(const DoubleDouble& x);
/// The same with the system's functions, in double.
inline SineCosine<double> sineCosine(double x) { return {std::sin(x), std::cos(x)}; }

/// sinh(x) and cosh(x) for |x| <= 50, with relative errors of at most 2e-31 (1 + 4 |x|).
struct HyperbolicSineCosine {
  DoubleDouble sinh, cosh;
};
HyperbolicSineCosine hyperbolicSineCosine(const DoubleDouble& x);

}  // namespace limitsurf
