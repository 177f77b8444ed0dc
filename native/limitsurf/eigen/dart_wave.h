// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "limitsurf/eigen/circle.h"
#include "limitsurf/eigen/power.h"
#include "limitsurf/precision/complex.h"

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
  using Real = RealOf<Scalar>;

  CircleWave(int faces, int multiple, const Scalar& delta)
      : faces_(faces),
        multiple_(multiple),
        delta_(delta),
        circle_(std::int64_t{4} * faces),
        first_(at(1)) {
    using std::sqrt;
    s_ = (first_.cos + sqrt(first_.cos * first_.cos + Real(4))) / Real(4);
  }

  int multiple() const { return multiple_; }
  const Scalar& delta() const { return delta_; }
  const Scalar& root() const { return s_; }  ///< s
  Scalar lambda() const { return s_ * s_; }
  /// cos(psi n) and sin(psi n).
  SineCosine<Scalar> at(std::int64_t n) const {
    const SineCosine<Real> pole = circle_.at(multiple_ * n);
    const SineCosine<Scalar> turn = sineCosine(delta_ * static_cast<Real>(n));
    return {pole.sin * turn.cos + pole.cos * turn.sin, pole.cos * turn.cos - pole.sin * turn.sin};
  }
  /// at(1).
  const SineCosine<Scalar>& first() const { return first_; }

  Scalar value(int n) const { return onSpoke(n) ? at(n).cos : at(n).cos / s_; }
  /// The sum of the wave over all faces.
  Scalar faceSum() const { return at(faces_).sin / (first_.sin * s_); }

 private:
  bool onSpoke(int n) const { return (faces_ - n) % 2 == 0; }

  int faces_, multiple_;
  Scalar delta_;
  Circle<Real> circle_;
  SineCosine<Scalar> first_;
  Scalar s_;
};

/// A wave that decays away from e_0, with or without alternating signs: lambda lies outside the
/// spectrum of B(phi), psi or psi - pi/2 is imaginary. It is scaled so that it is about 1/2 at e_0:
/// (z^((N - n) / 2) + z^((N + n) / 2)) / 2 with z = e^(2 i psi) real, -1 < z < 1.
template <typename Real>
class DecayingWave {
 public:
  DecayingWave(int faces, Real lambda) : faces_(faces), lambda_(lambda) {
    using std::abs;
    using std::sqrt;
    const Real d = lambda * lambda - 3 * lambda / 4 + Real(1) / 16;
    const Real z_by_lambda = 1 / (8 * lambda * lambda - 5 * lambda + Real(1) / 2 +
                                  8 * sqrt(d) * abs(lambda - Real(1) / 4));
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
  Real power(int n) const { return limitsurf::power(z_, n, Real(1)); }

  int faces_;
  Real lambda_, z_, face_;
};

/// cos(psi n) and sin(psi n) for |n| <= N in O(sqrt N) memory and constant time, as a product of
/// two powers of e^(i psi): one for each digit of n in base sqrt N, about.
template <typename Real>
class WavePowers {
 public:
  WavePowers() = default;
  WavePowers(const CircleWave<Real>& wave, int faces) {
    while (digits_ * digits_ <= faces) {
      digits_ += 2;
    }
    low_ = powers(wave.first(), digits_);
    high_ = powers(wave.at(digits_), faces / digits_ + 1);
  }
  template <typename Wider>
  explicit WavePowers(const WavePowers<Wider>& other) : digits_(other.digits()) {
    for (const auto& power : other.low()) {
      low_.push_back({static_cast<Real>(power.sin), static_cast<Real>(power.cos)});
    }
    for (const auto& power : other.high()) {
      high_.push_back({static_cast<Real>(power.sin), static_cast<Real>(power.cos)});
    }
  }

  using Power = SineCosine<Real>;
  Power at(int n) const {
    const int size = std::abs(n);
    const Power power = product(high_[size / digits_], low_[size % digits_]);
    return {n < 0 ? -power.sin : power.sin, power.cos};
  }

  int digits() const { return digits_; }  ///< the base, an even number
  const std::vector<Power>& low() const { return low_; }
  const std::vector<Power>& high() const { return high_; }

 private:
  static Power product(const Power& a, const Power& b) {
    return {a.sin * b.cos + a.cos * b.sin, a.cos * b.cos - a.sin * b.sin};
  }
  static std::vector<Power> powers(const Power& base, int count) {
    std::vector<Power> result = {{0, 1}};
    while (static_cast<int>(result.size()) < count) {
      result.push_back(product(result.back(), base));
    }
    return result;
  }

  int digits_ = 2;
  std::vector<Power> low_, high_;
};

/// Sums of cos(psi n) and of its square over the places n < N of the same parity, each as often as
/// it has points.
template <typename Real>
struct CosineSums {
  Real first[2] = {0, 0}, square[2] = {0, 0};

  /// O(sqrt N): the products of high and low digits are summed factor by factor.
  CosineSums(const WavePowers<Real>& powers, int faces) {
    Real cos[2] = {0, 0}, sin[2] = {0, 0}, cos_cos[2] = {0, 0}, cos_sin[2] = {0, 0},
         sin_sin[2] = {0, 0};
    for (int i = 0; i < powers.digits(); ++i) {
      const auto& low = powers.low()[i];
      cos[i % 2] += low.cos;
      sin[i % 2] += low.sin;
      cos_cos[i % 2] += low.cos * low.cos;
      cos_sin[i % 2] += low.cos * low.sin;
      sin_sin[i % 2] += low.sin * low.sin;
    }
    const int blocks = faces / powers.digits();
    for (int block = 0; block < blocks; ++block) {
      const auto& high = powers.high()[block];
      const Real both = high.cos * high.sin;
      for (int p = 0; p < 2; ++p) {
        first[p] += high.cos * cos[p] - high.sin * sin[p];
        square[p] += high.cos * high.cos * cos_cos[p] - 2 * both * cos_sin[p] +
                     high.sin * high.sin * sin_sin[p];
      }
    }
    for (int n = blocks * powers.digits(); n < faces; ++n) {
      const Real value = powers.at(n).cos;
      first[n % 2] += value;
      square[n % 2] += value * value;
    }
    for (int p = 0; p < 2; ++p) {  // two points at each place but n = 0
      first[p] = 2 * first[p] - (p == 0 ? 1 : 0);
      square[p] = 2 * square[p] - (p == 0 ? 1 : 0);
    }
  }
};

}  // namespace limitsurf
