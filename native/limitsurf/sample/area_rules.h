// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// The rule of Gauss and Legendre with N points on [0, 1], and the Bernstein polynomials there.
template <int N>
struct GaussRule {
  double weight[N];
  double quadratic[N][3];  ///< Bernstein polynomials of degree 2 at each point
  double cubic[N][4];      ///< and of degree 3

  constexpr GaussRule(const double (&at)[N], const double (&weights)[N])
      : weight(), quadratic(), cubic() {
    for (int i = 0; i < N; ++i) {
      const double t = at[i], s = 1 - t;
      weight[i] = weights[i];
      quadratic[i][0] = s * s;
      quadratic[i][1] = 2 * s * t;
      quadratic[i][2] = t * t;
      cubic[i][0] = s * s * s;
      cubic[i][1] = 3 * s * s * t;
      cubic[i][2] = 3 * s * t * t;
      cubic[i][3] = t * t * t;
    }
  }
};

inline constexpr GaussRule<1> kGauss1({0.5}, {1});
inline constexpr GaussRule<2> kGauss2({0.21132486540518713, 0.7886751345948129}, {0.5, 0.5});
inline constexpr GaussRule<3> kGauss3({0.1127016653792583, 0.5, 0.8872983346207417},
                                      {0.2777777777777778, 0.4444444444444444, 0.2777777777777778});
inline constexpr GaussRule<4> kGauss4({0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                       0.9305681557970262},
                                      {0.17392742256872692, 0.32607257743127305,
                                       0.32607257743127305, 0.17392742256872692});
inline constexpr GaussRule<6> kGauss6({0.033765242898423975, 0.16939530676686776,
                                       0.38069040695840156, 0.6193095930415985, 0.8306046932331322,
                                       0.966234757101576},
                                      {0.08566224618958525, 0.1803807865240693, 0.23395696728634546,
                                       0.23395696728634546, 0.1803807865240693,
                                       0.08566224618958525});

/// The derivatives of a bicubic patch on a square of its parameters, for quadratures of |ds x dt|.
class AreaIntegrand {
 public:
  /// The coordinates of the patch's 16 control points, axis by axis.
  using Points = double[3][16];

  explicit AreaIntegrand(const Points& points) {
    double along_s = 0, along_t = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double* p = points[axis];
      for (int row = 0; row < 4; ++row) {
        for (int i = 0; i < 3; ++i) {
          ds_[axis][row][i] = 3 * (p[4 * row + i + 1] - p[4 * row + i]);
          along_s = std::max(along_s, std::abs(ds_[axis][row][i]));
        }
      }
      for (int row = 0; row < 3; ++row) {
        for (int i = 0; i < 4; ++i) {
          dt_[axis][row][i] = 3 * (p[4 * row + 4 + i] - p[4 * row + i]);
          along_t = std::max(along_t, std::abs(dt_[axis][row][i]));
        }
      }
    }
    rounding_ = kRounding * along_s * along_t;
  }

  /// What is known of folds: whether ds x dt can turn over within the square, so that its length
  /// has kinks that all points of a rule may miss.
  struct Folds {
    double signed_area;  ///< the integral of (ds x dt) n, n a unit vector
    double turned;       ///< at least the integral of its negative part, with its sign changed
  };
  /// Whether (ds x dt) n > 0 everywhere, n the normal in the middle. May be false where it is so.
  bool isUpright() const;
  Folds folds() const;

  /// More than the rounding errors of any quadrature.
  double rounding() const { return rounding_; }

  template <int N>
  double quadrature(const GaussRule<N>& rule) const {
    double sum = 0;
    for (int j = 0; j < N; ++j) {
      double s[3][N], t[3][N];
      for (int axis = 0; axis < 3; ++axis) {
        double p[3], q[4];
        for (int i = 0; i < 3; ++i) {
          p[i] = (rule.cubic[j][0] * ds_[axis][0][i] + rule.cubic[j][1] * ds_[axis][1][i]) +
                 (rule.cubic[j][2] * ds_[axis][2][i] + rule.cubic[j][3] * ds_[axis][3][i]);
        }
        for (int i = 0; i < 4; ++i) {
          q[i] = rule.quadratic[j][0] * dt_[axis][0][i] + rule.quadratic[j][1] * dt_[axis][1][i] +
                 rule.quadratic[j][2] * dt_[axis][2][i];
        }
        for (int i = 0; i < N; ++i) {
          s[axis][i] = rule.quadratic[i][0] * p[0] + rule.quadratic[i][1] * p[1] +
                       rule.quadratic[i][2] * p[2];
          t[axis][i] = (rule.cubic[i][0] * q[0] + rule.cubic[i][1] * q[1]) +
                       (rule.cubic[i][2] * q[2] + rule.cubic[i][3] * q[3]);
        }
      }
      double row = 0;
      for (int i = 0; i < N; ++i) {
        const double x = s[1][i] * t[2][i] - s[2][i] * t[1][i];
        const double y = s[2][i] * t[0][i] - s[0][i] * t[2][i];
        const double z = s[0][i] * t[1][i] - s[1][i] * t[0][i];
        row += rule.weight[i] * std::sqrt(x * x + y * y + z * z);
      }
      sum += rule.weight[j] * row;
    }
    return sum;
  }

 private:
  static constexpr double kRounding = 4e-15;

  double ds_[3][4][3], dt_[3][3][4];  // Bezier points of the derivatives
  double rounding_;
};

}  // namespace limitsurf
