// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "limitsurf/eigen/dart_wave.h"

namespace limitsurf {

/// The eigenvalues of a dart's ring whose eigenvectors are symmetric about the sharp spoke, but for
/// the constant one: N + 1 for N faces.
///
/// Sharpness changes one row of the smooth ring's matrix, a change of rank 1, so that the
/// eigenvalues solve a secular equation. With psi, s and lambda as in dart_wave.h,
/// D = lambda^2 - 3/4 lambda + 1/16 and N Q = N D + 7/4 lambda - 3/16 (whose roots are the radial
/// eigenvalues of the smooth ring), it reads
///     N (2 lambda - 1) (N Q) cos(N psi) = (s / 2) (3/2 lambda - 1/4) sin(N psi) / sin(psi)
/// where both sides vanish at D = 0 as well, which is none. cos(N psi) vanishes at the poles psi =
/// (2 k + 1) pi / (2 N), k = 0, ..., N - 1. Between two of them the difference of both sides
/// changes sign, unless 3/2 lambda - 1/4 does: N - 2 eigenvalues. One lies below those of the
/// poles. The last two are what the traces of S and S^2 leave: a complex pair near 1/2 for most N,
/// else real.
struct DartSpectrum {
  using Real = long double;
  using Complex = std::complex<Real>;

  explicit DartSpectrum(int faces);

  Real lowest = 0;
  std::vector<CircleWave<Real>> waves;
  /// The two that are the closest to being a double one: real or conjugate.
  std::vector<CircleWave<Complex>> pair;
};

}  // namespace limitsurf
