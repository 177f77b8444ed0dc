// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/eigen/ring.h"
#include "limitsurf/precision/double_double.h"

namespace limitsurf {

/// An eigenvector of a sector's ring that does not vanish on the bounding curve v, e_0, e_k. It is
/// continued from the curve to the inner spokes and faces in closed form.
///
/// Where a spoke mode has the same eigenvalue as the curve and no continuation exists, the vector
/// is a generalised eigenvector instead: S g = lambda g + `feeds` w, where w is the spoke mode
/// number `fed_mode` (Lacewell & Burley 2007, section 3.1). On boundaries, whose valence N is k + 1
/// for k faces, this happens at 1/4 for even N and at 1/2 for N = 5, 9, 13, ..., as their figure 4
/// says; in pinned corners at 1/2 for odd N; in loops of k faces at 1/4 for odd k and at 1/2 for
/// k = 2, 6, 10, ...
template <typename Real>
struct CurveMode {
  Real lambda = 0;
  std::vector<Real> ring;   ///< one value per point of the ring
  int fed_mode = 0;         ///< the spoke mode m that this vector feeds; 0: none
  bool feeds_plus = false;  ///< whether w is the lambda+ eigenvector of that mode; else lambda-
  Real feeds = 0;
};

/// The sector's curve modes without the constant one.
///   boundary: tangent (1/2; v = 0, e_0 = 1, e_k = -1) and bend (1/4; v = -1, e_0 = e_k = 2);
///   pinned: difference (1/2; e_0 = 1, e_k = -1) and sum (1/2; e_0 = e_k = 1), both with v = 0;
///   loop: those of a boundary, where e_k is the crease's other far end. Its last face has e_0 for
///   that spoke, so that its tangent is continued like the sum of a pinned corner.
template <typename Real>
std::vector<CurveMode<Real>> curveModes(const Ring& ring);

/// The coefficients of the constant and of the two curve modes, which the curve's own three points
/// determine.
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

extern template std::vector<CurveMode<DoubleDouble>> curveModes(const Ring&);

}  // namespace limitsurf
