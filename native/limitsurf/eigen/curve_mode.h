// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/eigen/ring.h"

namespace limitsurf {

/// An eigenvector of a sector's ring in which the bounding curve v, e_0, e_k moves, continued to
/// the inner spokes and faces in closed form.
///
/// Where the curve's eigenvalue meets an equal one of the spoke modes and no continuation exists,
/// the vector is a generalised one: S g = lambda g + `feeds` w, with w the spoke mode number
/// `fed_mode` (paper, section 3.1).
template <typename Real>
struct CurveMode {
  Real lambda = 0;
  std::vector<Real> ring;   ///< one value per point of the ring
  int fed_mode = 0;         ///< spoke mode m fed by this vector; 0: none
  bool feeds_plus = false;  ///< w is the mode's lambda+ eigenvector, else its lambda- one
  Real feeds = 0;
};

/// The sector's curve modes apart from the constant one.
///   boundary: tangent (1/2; v = 0, e_0 = 1, e_k = -1) and bend (1/4; v = -1, e_0 = e_k = 2);
///   pinned: difference (1/2; e_0 = 1, e_k = -1) and sum (1/2; e_0 = e_k = 1), both with v = 0.
template <typename Real>
std::vector<CurveMode<Real>> curveModes(const Ring& ring);

/// Coefficients (constant, first, second) of the curve's own three points.
template <typename Vector>
struct CurveCoefficients {
  Vector constant, first, second;
};

template <typename Vector>
CurveCoefficients<Vector> curveCoefficients(RingKind kind, const Vector& v, const Vector& e_0,
                                            const Vector& e_k) {
  if (kind == RingKind::pinned) {
    return {v, (e_0 - e_k) / 2, (e_0 + e_k) / 2 - v};
  }
  const Vector bend = ((e_0 + e_k) / 2 - v) / 3;
  return {v + bend, (e_0 - e_k) / 2, bend};
}

extern template std::vector<CurveMode<double>> curveModes(const Ring&);
extern template std::vector<CurveMode<long double>> curveModes(const Ring&);

}  // namespace limitsurf
