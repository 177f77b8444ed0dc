// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/precision/double_double.h"

namespace limitsurf {

/// The two eigenvectors of a ring that turn by the angle phi from spoke to spoke.
///
/// On fields e_i = x_e cos(phi i), f_j = x_f cos(phi (j + 1/2)) (or sin) with v = 0, subdivision
/// acts as B(phi) = [3/8 + cos(phi)/8, c/8; c/2, 1/4], c = cos(phi/2). These are the blocks into
/// which a discrete Fourier transform takes the ring matrix (Stam 1998, appendix A); with other
/// angles they serve sectors as well. In (x_e, x_f / 2) B is symmetric, so that its unit
/// eigenvectors are orthogonal, and with s = sqrt(4 + c^2)
///     lambda+ = 1/4 + c (c + s) / 8,    lambda- = 1 / (16 lambda+),    tan(alpha) = 2 / (c + s),
/// where no two numbers cancel. At phi = pi/2, where lambda+ = 1/2 and the mode is a linear
/// function on every face, the eigenvector has the length sqrt(3/2), so that its values there are
/// integers: its second derivatives, which are multiplied by 4^n, have to vanish exactly.
template <typename Real>
struct SpokeMode {
  Real lambda_plus, lambda_minus;
  bool linear;  ///< whether the mode to lambda+ is a linear function on every face

  /// An eigenvector (x_e, x_f), and its length in (x_e, x_f / 2), squared.
  struct Vector {
    Real edge, face, square;
  };
  Vector plus, minus;

  Real lambda(bool is_plus) const { return is_plus ? lambda_plus : lambda_minus; }
  const Vector& vector(bool is_plus) const { return is_plus ? plus : minus; }

  /// The modes to phi = pi numerator / denominator. Integers make it possible to recognise exactly
  /// the angles at which an eigenvalue is rational.
  static SpokeMode at(std::int64_t numerator, std::int64_t denominator);
};

extern template struct SpokeMode<DoubleDouble>;

}  // namespace limitsurf
