// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/curves/curve_cubic.h"

namespace limitsurf {
namespace {

/// The points and weights of Gauss-Legendre quadrature on [-1, 1], the positive half.
constexpr int kPairs = 5;
constexpr double kAt[kPairs] = {0.14887433898163122, 0.43339539412924719, 0.67940956829902441,
                                0.86506336668898451, 0.97390652851717172};
constexpr double kWeight[kPairs] = {0.29552422471475287, 0.26926671930999635, 0.21908636251598204,
                                    0.14945134915058059, 0.066671344308688138};

}  // namespace

double CurveCubic::quadrature(double from, double to) const {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int i = 0; i < kPairs; ++i) {
    sum += kWeight[i] * (speed(middle - half * kAt[i]) + speed(middle + half * kAt[i]));
  }
  return half * sum;
}

}  // namespace limitsurf
