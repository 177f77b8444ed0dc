// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/squared_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limitsurf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The relative rounding of differences of coefficients.
constexpr double kRounding = 1e-14;
/// A polynomial of degree 6 has second derivatives of 6 * 5 = 30 times the second differences of
/// its coefficients, and mixed ones of 6 * 6 = 36 times the mixed differences.
constexpr double kSecond = 30, kMixed = 36;
constexpr double kBinomial3[4] = {1, 3, 3, 1};
constexpr double kInverse6[7] = {1,       1. / 6, 1. / 15, 1. / 20,  // of the binomials
                                 1. / 15, 1. / 6, 1};

}  // namespace

SquaredDistance::SquaredDistance(const BezierPatch::Point points[16],
                                 const BezierPatch::Point& away) {
  // |P|^2 - 2 P away. With the binomials multiplied in, the product of two polynomials is a
  // convolution.
  double x[3][16];
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        x[axis][4 * j + i] = kBinomial3[i] * kBinomial3[j] * points[4 * j + i][axis];
      }
    }
  }
  double sum[7 * 7] = {};
  const auto addRows = [&](int a, int b, double factor) {
    double* out = sum + 7 * (a + b);
    for (int axis = 0; axis < 3; ++axis) {
      const double *p = x[axis] + 4 * a, *q = x[axis] + 4 * b;
      for (int i = 0; i < 4; ++i) {
        const double scaled = factor * p[i];
        for (int k = 0; k < 4; ++k) {
          out[i + k] += scaled * q[k];
        }
      }
    }
  };
  for (int a = 0; a < 4; ++a) {
    addRows(a, a, 1);
    for (int b = a + 1; b < 4; ++b) {
      addRows(a, b, 2);
    }
  }
  if (!(away == 0).all()) {
    for (int a = 0; a < 4; ++a) {
      for (int i = 0; i < 4; ++i) {
        const double linear = -2 * (x[0][4 * a + i] * away[0] + x[1][4 * a + i] * away[1] +
                                    x[2][4 * a + i] * away[2]);
        for (int b = 0; b < 4; ++b) {
          for (int k = 0; k < 4; ++k) {
            sum[7 * (a + b) + i + k] += linear * kBinomial3[b] * kBinomial3[k];
          }
        }
      }
    }
  }
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 7; ++i) {
      f_.at(i, j) = sum[7 * j + i] * (kInverse6[i] * kInverse6[j]);
    }
  }
  f_.pad();
}

void SquaredDistance::quarter(SquaredDistance out[4]) const {
  Bernstein<6> parts[4];
  f_.quarter(parts);
  for (int i = 0; i < 4; ++i) {
    out[i].f_ = parts[i];
  }
}

void SquaredDistance::guess(double& s, double& t) const {
  const double least = f_.least();
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 7; ++i) {
      if (f_.at(i, j) == least) {
        s = i / 6.;
        t = j / 6.;
        return;
      }
    }
  }
}

SquaredDistance::Shape SquaredDistance::shape(double slack) const {
  Shape shape;
  double low = kInfinity, high = -kInfinity;
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 6; ++i) {
      const double d = f_.at(i + 1, j) - f_.at(i, j);
      low = std::min(low, d);
      high = std::max(high, d);
    }
  }
  const double rounding = kRounding * magnitude();
  shape.s_side = low >= 0 ? -1 : high <= 0 ? 1 : 0;
  shape.s_strictly = low > rounding || high < -rounding;
  low = kInfinity;
  high = -kInfinity;
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 7; ++i) {
      const double d = f_.at(i, j + 1) - f_.at(i, j);
      low = std::min(low, d);
      high = std::max(high, d);
    }
  }
  shape.t_side = low >= 0 ? -1 : high <= 0 ? 1 : 0;
  shape.t_strictly = low > rounding || high < -rounding;

  if (shape.s_side != 0 && shape.t_side != 0) {
    shape.convex = true;
  } else if (shape.s_side != 0) {
    const int i = shape.s_side < 0 ? 0 : 6;
    double second = kInfinity;
    for (int j = 0; j < 5; ++j) {
      second = std::min(second, f_.at(i, j) - 2 * f_.at(i, j + 1) + f_.at(i, j + 2));
    }
    shape.convex = kSecond * second + slack > 0;
  } else if (shape.t_side != 0) {
    const int j = shape.t_side < 0 ? 0 : 6;
    double second = kInfinity;
    for (int i = 0; i < 5; ++i) {
      second = std::min(second, f_.at(i, j) - 2 * f_.at(i + 1, j) + f_.at(i + 2, j));
    }
    shape.convex = kSecond * second + slack > 0;
  } else {
    shape.convex = isConvex(slack);
  }
  return shape;
}

bool SquaredDistance::isConvex(double slack) const {
  double ss = kInfinity, tt = kInfinity, st = 0;
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 5; ++i) {
      ss = std::min(ss, f_.at(i, j) - 2 * f_.at(i + 1, j) + f_.at(i + 2, j));
    }
  }
  ss = kSecond * ss + slack;
  if (!(ss > 0)) {
    return false;
  }
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 7; ++i) {
      tt = std::min(tt, f_.at(i, j) - 2 * f_.at(i, j + 1) + f_.at(i, j + 2));
    }
  }
  tt = kSecond * tt + slack;
  if (!(tt > 0)) {
    return false;
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) {
      st = std::max(
          st, std::abs((f_.at(i + 1, j + 1) - f_.at(i, j + 1)) - (f_.at(i + 1, j) - f_.at(i, j))));
    }
  }
  st *= kMixed;
  return ss * tt >= st * st;
}

bool SquaredDistance::isNowhereConvex() const {
  double ss = -kInfinity, tt = -kInfinity, low = kInfinity, high = -kInfinity;
  for (int j = 0; j < 7; ++j) {
    for (int i = 0; i < 5; ++i) {
      ss = std::max(ss, f_.at(i, j) - 2 * f_.at(i + 1, j) + f_.at(i + 2, j));
      tt = std::max(tt, f_.at(j, i) - 2 * f_.at(j, i + 1) + f_.at(j, i + 2));
    }
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) {
      const double st = (f_.at(i + 1, j + 1) - f_.at(i, j + 1)) - (f_.at(i + 1, j) - f_.at(i, j));
      low = std::min(low, st);
      high = std::max(high, st);
    }
  }
  const double rounding = kRounding * magnitude();
  const double st = kMixed * std::max({0., low, -high});
  return ss < -rounding || tt < -rounding ||
         kSecond * (ss + rounding) * kSecond * (tt + rounding) < st * st;
}

}  // namespace limitsurf
