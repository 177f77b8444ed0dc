// SPDX-License-Identifier: Apache-2.0
#pragma once

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

inline constexpr GaussRule<3> kGauss3({0.1127016653792583, 0.5, 0.8872983346207417},
                                      {0.2777777777777778, 0.4444444444444444, 0.2777777777777778});
/// The rule with N points, an even number, in pairs at equal distances from the middle of [0, 1].
template <int N>
struct PairedRule {
  static constexpr int kPairs = N / 2;
  static_assert(N % 2 == 0, "The point in the middle has no partner.");
  /// Degrees of two Legendre polynomials: the highest that the rule tells from lower ones, and
  /// another one below it. Both are odd.
  static constexpr int kHighest = N - 1, kLower = N < 8 ? N - 3 : N - 5;

  double offset[kPairs];  ///< the distances
  double weight[kPairs];
  double highest[kPairs], lower[kPairs];  ///< these polynomials beyond the middle, times the weight

  constexpr PairedRule(const double (&at)[kPairs], const double (&weights)[kPairs])
      : offset(), weight(), highest(), lower() {
    for (int i = 0; i < kPairs; ++i) {
      offset[i] = at[i] - 0.5;
      weight[i] = weights[i];
      highest[i] = weights[i] * legendre(kHighest, 2 * offset[i]);
      lower[i] = weights[i] * legendre(kLower, 2 * offset[i]);
    }
  }

 private:
  static constexpr double legendre(int degree, double x) {
    double value = 1, before = 0;
    for (int k = 0; k < degree; ++k) {
      const double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
      before = value;
      value = next;
    }
    return value;
  }
};

inline constexpr PairedRule<4> kGauss4({0.6699905217924281, 0.9305681557970262},
                                       {0.32607257743127305, 0.17392742256872692});
inline constexpr PairedRule<6> kGauss6({0.6193095930415985, 0.8306046932331322, 0.966234757101576},
                                       {0.23395696728634546, 0.1803807865240693,
                                        0.08566224618958525});
inline constexpr PairedRule<8> kGauss8({0.5917173212478249, 0.7627662049581645, 0.8983332387068134,
                                        0.9801449282487681},
                                       {0.18134189168918099, 0.15685332293894364,
                                        0.11119051722668724, 0.05061426814518813});

}  // namespace limitsurf
