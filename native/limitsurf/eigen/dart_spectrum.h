// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limitsurf/eigen/dart_wave.h"

namespace limitsurf {

/// The eigenvalues of a dart's ring whose eigenvectors are symmetric about the sharp spoke, without
/// the constant one's: N + 1 for N faces.
///
/// Sharpness changes one row of the smooth ring's matrix. This is a change of rank 1, so that the
/// eigenvalues solve a secular equation. With psi, s and lambda as in dart_wave.h,
/// D = lambda^2 - 3/4 lambda + 1/16 and N Q = N D + 7/4 lambda - 3/16 (whose roots are the radial
/// eigenvalues of the smooth ring), it reads
///     N (2 lambda - 1) (N Q) cos(N psi) = (s / 2) (3/2 lambda - 1/4) sin(N psi) / sin(psi)
/// Both sides vanish at D = 0 as well, which is no eigenvalue. cos(N psi) vanishes at the poles
/// psi = (2 k + 1) pi / (2 N), k = 0, ..., N - 1. Between two of them the difference of both sides
/// changes its sign, unless 3/2 lambda - 1/4 does: this gives N - 2 eigenvalues. Where N is
/// divisible by 4, one of them is 1/2, exactly midway between two poles, and for N = 4 the other
/// one is 1/4, midway as well. One more lies below those of the poles. The last two follow from the
/// traces of S and S^2: for most N they are a complex pair near 1/2, else they are real.
struct DartSpectrum {
  using Real = DoubleDouble;

  explicit DartSpectrum(int faces);

  Real lowest = 0;
  std::vector<CircleWave<Real>> waves;
  /// The two eigenvalues that are closest to each other, real or conjugate.
  std::vector<CircleWave<Complex>> pair;
};

}  // namespace limitsurf
