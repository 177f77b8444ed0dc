// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <utility>

#include "limitsurf/precision/complex.h"

namespace limitsurf {

/// A vector on a dart's ring that is symmetric about the sharp spoke and follows a wave of
/// dart_wave.h everywhere but at the vertex and at e_0.
template <typename Scalar>
struct DartVector {
  Scalar vertex, sharp;  ///< at v, at e_0
  Scalar edge_constant, edge_wave, face_constant, face_wave;

  template <typename Factor>
  void scale(const Factor& factor) {
    for (Scalar* part : {&vertex, &sharp, &edge_constant, &edge_wave, &face_constant, &face_wave}) {
      *part *= factor;
    }
  }

  /// The vector at the place n of N (dart_wave.h), where the wave has the value `wave`.
  Scalar at(int n, int faces, const Scalar& wave) const {
    return n == faces             ? sharp
           : (faces - n) % 2 == 0 ? edge_constant + edge_wave * wave
                                  : face_constant + face_wave * wave;
  }
};

/// The right and the left eigenvector to the wave's eigenvalue; their lengths are arbitrary.
///
/// Away from v and e_0 the ring of a dart is that of a smooth vertex, where v's motion drives e and
/// f by constants and the wave turns freely. To the right, e_0 continues the wave of the other
/// spokes, whose values are W:
///     (lambda - B(0)) (alpha, beta) = v (3/8, 1/4),    e_0 = alpha + lambda W_N = v / (2 lambda -
///     1).
/// To the left, where only e_0 itself and v depend on e_0's row, the wave goes on to 0 there:
///     (lambda - B(0)^T) (alpha, beta) = v (3/2, 1/4) / N^2,    alpha + (3/2 lambda - 1/4) W_N = 0.
/// Common denominators are multiplied out. The remaining equation, for v, is the secular one
/// (dart_spectrum.h). With its help the left vector's e_0 can be written in two forms, which are
/// singular at different eigenvalues.
template <typename Wave>
struct DartVectors {
  using Scalar = decltype(Wave(std::declval<Wave>()).lambda());

  DartVector<Scalar> right, left;

  DartVectors(int faces, const Wave& wave) {
    using std::abs;
    using Real = RealOf<Scalar>;
    const Real n = static_cast<Real>(faces), quarter = Real(1) / 4, one = 1;
    const Scalar lambda = wave.lambda(), end = wave.value(faces);
    const Scalar d = lambda * lambda - 3 * quarter * lambda + Real(1) / 16;
    const Scalar twice = Real(2) * lambda - one, omega = 6 * quarter * lambda - quarter;

    const Scalar k = end / (one - lambda);
    right.sharp = -Real(4) * d * k;
    right.vertex = twice * right.sharp;
    right.edge_constant = -twice * omega * k;
    right.face_constant = -twice * (lambda + quarter) * k;
    right.edge_wave = right.face_wave = lambda;

    left.vertex = -n * n * d * end;
    left.edge_constant = -omega * end;
    left.face_constant = -quarter * (lambda + quarter) * end;
    left.edge_wave = omega;
    left.face_wave = quarter * omega;
    if (abs(lambda - Real(1) / 2) > quarter) {
      left.sharp = -Real(4) * d * omega * wave.faceSum() / twice;
    } else {
      const Scalar n_q = n * d + 7 * quarter * lambda - Real(3) / 16;
      left.sharp = -Real(8) * n * d * n_q * end / lambda;
    }
  }
};

}  // namespace limitsurf
