// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/curve_mode.h"

#include <cmath>

namespace limitsurf {
namespace {

// cos(pi i / 2), sin(pi i / 2), and sqrt(2) times both at half-integers i + 1/2.
template <typename Real>
Real cosEdge(int i) {
  constexpr int values[4] = {1, 0, -1, 0};
  return static_cast<Real>(values[i & 3]);
}
template <typename Real>
Real sinEdge(int i) {
  return cosEdge<Real>(i + 3);
}
template <typename Real>
Real cosFace(int j) {
  constexpr int values[4] = {1, -1, -1, 1};
  return static_cast<Real>(values[j & 3]);
}
template <typename Real>
Real sinFace(int j) {
  return cosFace<Real>(j + 3);
}

/// Eigenvalue 1/2 with v = 0, e_0 = 1, e_k = end (1 or -1): a combination of the two spoke modes of
/// phi = pi/2, whose eigenvector is (x_e, x_f) = (1, sqrt 2).
///
/// For even k, sin(pi k / 2) = 0, so that e_k = cos(pi k / 2). Where that is not `end`, a multiple
/// of the derivative of the sine mode with respect to phi is added,
/// x' = (i cos(phi i), rho' sin + rho (j + 1/2) cos). It is a generalised eigenvector:
/// (S - mu) x' = mu' (sine mode), with mu' = -1/6, rho = sqrt 2, rho' = sqrt 2 / 6 at pi/2.
template <typename Real>
CurveMode<Real> halfMode(const Ring& ring, int end) {
  const int k = ring.faces;
  CurveMode<Real> mode;
  mode.lambda = Real(1) / 2;
  mode.ring.assign(ring.size(), 0);
  const bool odd = k % 2 != 0;
  const bool defective = !odd && cosEdge<Real>(k) != end;
  const Real sine = odd ? static_cast<Real>(end) * sinEdge<Real>(k) : 0;
  const Real slope = defective ? Real(2) / k : 0;
  for (int i = 0; i <= k; ++i) {
    mode.ring[ring.edge(i)] = (1 - slope * i) * cosEdge<Real>(i) + sine * sinEdge<Real>(i);
  }
  for (int j = 0; j < k; ++j) {
    mode.ring[ring.face(j)] =
        (1 - slope * (j + Real(1) / 2)) * cosFace<Real>(j) + (sine - slope / 6) * sinFace<Real>(j);
  }
  if (defective) {
    mode.fed_mode = k / 2;
    mode.feeds_plus = true;
    mode.feeds = slope / 6;
  }
  return mode;
}

/// Eigenvalue 1/4 with v = -1, e_0 = e_k = 2. All f are 2. For even k, e_i alternates between 2 and
/// -1; for odd k the alternating part falls by `drift` from spoke to spoke, and the vector feeds
/// the mode f_j = (-1)^j.
template <typename Real>
CurveMode<Real> quarterMode(const Ring& ring) {
  const int k = ring.faces;
  CurveMode<Real> mode;
  mode.lambda = Real(1) / 4;
  mode.ring.assign(ring.size(), 2);
  mode.ring[0] = -1;
  const Real drift = k % 2 != 0 ? Real(3) / k : 0;
  for (int i = 0; i <= k; ++i) {
    const Real sign = i % 2 ? -1 : 1;
    mode.ring[ring.edge(i)] = Real(1) / 2 + sign * (Real(3) / 2 - drift * i);
  }
  if (k % 2 != 0) {
    mode.fed_mode = k;
    mode.feeds = drift / 4 / 2;  // the unit eigenvector of that mode has f_j = 2 (-1)^j
  }
  return mode;
}

}  // namespace

template <typename Real>
std::vector<CurveMode<Real>> curveModes(const Ring& ring) {
  switch (ring.kind) {
    case RingKind::boundary:
      return {halfMode<Real>(ring, -1), quarterMode<Real>(ring)};
    case RingKind::pinned:
      return {halfMode<Real>(ring, -1), halfMode<Real>(ring, 1)};
    case RingKind::loop: {
      CurveMode<Real> tangent = halfMode<Real>(ring, 1);
      tangent.ring[ring.edge(ring.faces)] = -1;  // of the crease, no spoke of a face
      return {tangent, quarterMode<Real>(ring)};
    }
    default:
      return {};
  }
}

template std::vector<CurveMode<DoubleDouble>> curveModes(const Ring&);

}  // namespace limitsurf
