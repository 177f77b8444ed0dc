// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// The two eigenvectors of a ring that turn by the angle phi from spoke to spoke.
///
/// On fields e_i = x_e cos(phi i), f_j = x_f cos(phi (j + 1/2)) (or sin) with v = 0, subdivision
/// acts as B(phi) = [3/8 + cos(phi)/8, c/8; c/2, 1/4], c = cos(phi/2): Stam's Fourier blocks, which
/// serve sectors as well. In (x_e, x_f / 2) it is symmetric, so its unit eigenvectors are
/// orthogonal, and with s = sqrt(4 + c^2)
///     lambda+ = 1/4 + c (c + s) / 8,    lambda- = 1 / (16 lambda+),    tan(alpha) = 2 / (c + s),
/// free of cancellation.
template <typename Real>
struct SpokeMode {
  Real lambda_plus, lambda_minus;
  Real cos_alpha, sin_alpha;

  /// (x_e, x_f) of the eigenvector to lambda+ and of the one to lambda-.
  Real edgePlus() const { return cos_alpha; }
  Real facePlus() const { return 2 * sin_alpha; }
  Real edgeMinus() const { return -sin_alpha; }
  Real faceMinus() const { return 2 * cos_alpha; }

  /// For phi = angle with numerator and denominator of angle / pi known, so that the angles where
  /// an eigenvalue is rational are met exactly.
  static SpokeMode at(long numerator, long denominator);
};

extern template struct SpokeMode<double>;
extern template struct SpokeMode<long double>;

}  // namespace limitsurf
