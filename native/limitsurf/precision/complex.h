// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/precision/elementary.h"

namespace limitsurf {

/// A complex number of double-doubles. (std::complex is defined for the built-in types alone.)
class Complex {
 public:
  using Real = DoubleDouble;

  Complex(const Real& real = 0, const Real& imag = 0) : real_(real), imag_(imag) {}
  template <typename Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  Complex(Number real) : real_(real) {}

  const Real& real() const { return real_; }
  const Real& imag() const { return imag_; }

  Complex operator-() const { return {-real_, -imag_}; }
  friend Complex operator+(const Complex& a, const Complex& b) {
    return {a.real_ + b.real_, a.imag_ + b.imag_};
  }
  friend Complex operator-(const Complex& a, const Complex& b) {
    return {a.real_ - b.real_, a.imag_ - b.imag_};
  }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.real_ * b.real_ - a.imag_ * b.imag_, a.real_ * b.imag_ + a.imag_ * b.real_};
  }
  friend Complex operator*(const Real& a, const Complex& b) { return {a * b.real_, a * b.imag_}; }
  friend Complex operator*(const Complex& a, const Real& b) { return b * a; }
  friend Complex operator/(const Complex& a, const Real& b) { return {a.real_ / b, a.imag_ / b}; }
  friend Complex operator/(const Complex& a, const Complex& b) {
    return a * Complex(b.real_, -b.imag_) / (b.real_ * b.real_ + b.imag_ * b.imag_);
  }
  Complex& operator+=(const Complex& b) { return *this = *this + b; }
  Complex& operator-=(const Complex& b) { return *this = *this - b; }
  template <typename Factor>
  Complex& operator*=(const Factor& b) {
    return *this = *this * b;
  }
  template <typename Factor>
  Complex& operator/=(const Factor& b) {
    return *this = *this / b;
  }

  friend Real abs(const Complex& a) { return sqrt(a.real_ * a.real_ + a.imag_ * a.imag_); }

  /// The root whose real part is not negative.
  friend Complex sqrt(const Complex& a) {
    const Real size = sqrt((abs(a) + abs(a.real_)) / 2);
    if (size == 0) {
      return 0;
    }
    const Real other = a.imag_ / (2 * size);
    if (a.real_ < 0) {
      return a.imag_ < 0 ? Complex(-other, -size) : Complex(other, size);
    }
    return {size, other};
  }

  friend SineCosine<Complex> sineCosine(const Complex& a) {
    const SineCosine<Real> circle = sineCosine(a.real_);
    const HyperbolicSineCosine growth = hyperbolicSineCosine(a.imag_);
    return {{circle.sin * growth.cosh, circle.cos * growth.sinh},
            {circle.cos * growth.cosh, -(circle.sin * growth.sinh)}};
  }

 private:
  Real real_, imag_;
};

/// The type of the real part of a number.
template <typename Scalar>
struct RealPart {
  using Type = Scalar;
};
template <>
struct RealPart<Complex> {
  using Type = Complex::Real;
};
template <typename Scalar>
using RealOf = typename RealPart<Scalar>::Type;

}  // namespace limitsurf
