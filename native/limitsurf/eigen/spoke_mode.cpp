// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/spoke_mode.h"

#include <cmath>

#include "limitsurf/eigen/circle.h"

namespace limitsurf {

template <typename Real>
SpokeMode<Real> SpokeMode<Real>::at(std::int64_t numerator, std::int64_t denominator) {
  using std::sqrt;
  SpokeMode mode;
  const Real c = Circle<Real>(4 * denominator).cos(numerator);
  const Real s = sqrt(4 + c * c);
  const Real length = sqrt((c + s) * (c + s) + 4);
  const Real cos_alpha = (c + s) / length, sin_alpha = 2 / length;
  mode.plus = {cos_alpha, 2 * sin_alpha, 1};
  mode.minus = {-sin_alpha, 2 * cos_alpha, 1};
  mode.linear = 2 * numerator == denominator;
  if (mode.linear) {  // phi = pi/2: lambda- = 1/8 is an eigenvalue of S12 as well
    mode.lambda_plus = Real(1) / 2;
    mode.lambda_minus = Real(1) / 8;
    mode.plus = {1, sqrt(Real(2)), Real(3) / 2};
  } else {
    mode.lambda_plus = Real(1) / 4 + c * (c + s) / 8;
    mode.lambda_minus = 1 / (16 * mode.lambda_plus);
  }
  if (numerator == denominator) {  // phi = pi: edges and faces are decoupled
    mode.plus = {1, 0, 1};
    mode.minus = {0, 2, 1};
  }
  return mode;
}

template struct SpokeMode<DoubleDouble>;

}  // namespace limitsurf
