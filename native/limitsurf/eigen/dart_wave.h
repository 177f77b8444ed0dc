// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "limitsurf/eigen/circle.h"

namespace limitsurf {

// A dart's modes that are symmetric about its sharp spoke e_0 follow waves around the vertex, which
// are symmetric about the point opposite e_0. Places are counted in half spokes from there: n = |2
// i - N| at e_i, |2 j + 1 - N| at f_j, so that e_0 is at n = N. With mu(2 psi) = lambda as in
// spoke_mode.h,
//     cos(psi) = 2 s - 1 / (2 s),    lambda = s^2,
// and the wave is cos(psi n) at spokes, cos(psi n) / s at faces.

/// A wave that neither grows nor decays, unless delta has an imaginary part:
/// psi = multiple pi / (2 N) + delta. At delta = 0 and an odd multiple, a pole of the spectrum, the
/// wave vanishes at e_0. Most eigenvalues lie so close to a pole that delta is stored instead of
/// psi, to keep its digits.
template <typename Scalar>
class CircleWave {
 public:
  using Real = decltype(std::abs(Scalar()));

  CircleWave(int faces, int multiple, const Scalar& delta)
      : faces_(faces), multiple_(multiple), delta_(delta), circle_(std::int64_t{4} * faces) {
    const Scalar c = cos(1);
    s_ = (c + std::sqrt(c * c + Real(4))) / Real(4);
  }

  int multiple() const { return multiple_; }
  const Scalar& delta() const { return delta_; }
  const Scalar& root() const { return s_; }  ///< s
  Scalar lambda() const { return s_ * s_; }
  Scalar cos(std::int64_t n) const {
    const Scalar turn = delta_ * static_cast<Real>(n);
    return at(n).real() * std::cos(turn) - at(n).imag() * std::sin(turn);
  }
  Scalar sin(std::int64_t n) const {
    const Scalar turn = delta_ * static_cast<Real>(n);
    return at(n).imag() * std::cos(turn) + at(n).real() * std::sin(turn);
  }

  Scalar value(int n) const { return onSpoke(n) ? cos(n) : cos(n) / s_; }
  /// The sum of the wave over all faces.
  Scalar faceSum() const { return sin(faces_) / (sin(1) * s_); }

 private:
  bool onSpoke(int n) const { return (faces_ - n) % 2 == 0; }
  std::complex<Real> at(std::int64_t n) const {
    const std::int64_t i = multiple_ * n;
    return {circle_.cos(i), circle_.sin(i)};
  }

  int faces_, multiple_;
  Scalar delta_;
  Circle<Real> circle_;
  Scalar s_;
};

/// A wave that decays away from e_0, with or without alternating signs: lambda lies outside the
/// spectrum of B(phi), psi or psi - pi/2 is imaginary. It is scaled so that it is about 1/2 at e_0:
/// (z^((N - n) / 2) + z^((N + n) / 2)) / 2 with z = e^(2 i psi) real, -1 < z < 1.
template <typename Real>
class DecayingWave {
 public:
  DecayingWave(int faces, Real lambda) : faces_(faces), lambda_(lambda) {
    const Real d = lambda * lambda - 3 * lambda / 4 + Real(1) / 16;
    const Real z_by_lambda = 1 / (8 * lambda * lambda - 5 * lambda + Real(1) / 2 +
                                  8 * std::sqrt(d) * std::abs(lambda - Real(1) / 4));
    z_ = z_by_lambda * lambda;
    face_ = (4 * lambda - 1) * z_by_lambda / (1 + z_);
  }

  Real lambda() const { return lambda_; }
  Real value(int n) const {
    const bool on_spoke = (faces_ - n) % 2 == 0;
    const int near = (faces_ - n) / 2, far = (faces_ + n - (on_spoke ? 0 : 1)) / 2;
    return (on_spoke ? 1 : face_) * (power(near) + power(far)) / 2;
  }
  Real faceSum() const { return face_ * (1 - power(faces_)) / (1 - z_); }
  /// tan(N psi) / (i s), where s is the sign of psi's imaginary part.
  Real tangent() const { return (1 - power(faces_)) / (1 + power(faces_)); }

 private:
  Real power(int n) const { return n == 0 ? 1 : std::pow(z_, static_cast<Real>(n)); }

  int faces_;
  Real lambda_, z_, face_;
};

/// cos(psi n) and sin(psi n) for |n| <= N in O(sqrt N) memory and constant time, as a product of
/// two powers of e^(i psi): one for each digit of n in base sqrt N.
template <typename Real>
class WavePowers {
 public:
  WavePowers() = default;
  WavePowers(const CircleWave<Real>& wave, int faces) {
    while (digits_ * digits_ <= faces) {
      ++digits_;
    }
    for (int i = 0; i < digits_; ++i) {
      low_.push_back({wave.cos(i), wave.sin(i)});
    }
    for (int i = 0; i * digits_ <= faces; ++i) {
      high_.push_back({wave.cos(i * digits_), wave.sin(i * digits_)});
    }
  }
  template <typename Wider>
  explicit WavePowers(const WavePowers<Wider>& other) : digits_(other.digits()) {
    for (const auto& power : other.low()) {
      low_.push_back({static_cast<Real>(power.cos), static_cast<Real>(power.sin)});
    }
    for (const auto& power : other.high()) {
      high_.push_back({static_cast<Real>(power.cos), static_cast<Real>(power.sin)});
    }
  }

  struct Power {
    Real cos, sin;
  };
  Power at(int n) const {
    const int size = std::abs(n);
    const Power &a = high_[size / digits_], &b = low_[size % digits_];
    const Real sine = a.sin * b.cos + a.cos * b.sin;
    return {a.cos * b.cos - a.sin * b.sin, n < 0 ? -sine : sine};
  }

  int digits() const { return digits_; }
  const std::vector<Power>& low() const { return low_; }
  const std::vector<Power>& high() const { return high_; }

 private:
  int digits_ = 1;
  std::vector<Power> low_, high_;
};

}  // namespace limitsurf
