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
inline constexpr GaussRule<8> kGauss8(
    {0.019855071751231884, 0.10166676129318663, 0.2372337950418355, 0.4082826787521751,
     0.5917173212478249, 0.7627662049581645, 0.8983332387068134, 0.9801449282487681},
    {0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
     0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813});

}  // namespace limitsurf
