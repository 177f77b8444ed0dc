// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/dart_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include "limitsurf/interruption_point.h"
#include "limitsurf/pi.h"

namespace limitsurf {
namespace {

using Real = DartSpectrum::Real;

/// 3/2 lambda - 1/4 changes its sign here, so that the secular equation's two sides do not cross
/// between the poles on either side.
constexpr Real kNoSignChange = Real(1) / 6;
/// First guesses are found in double, and have 10 digits or more. Each step of Newton's method
/// about doubles them; one step more than this takes is for close eigenvalues, which slow the
/// method down.
constexpr int kNewtonSteps = 3;
constexpr int kSecantSteps = 3;
/// By how much the sum of the last two eigenvalues, or of their squares, may differ from what the
/// traces leave for them. The traces are sums of O(N) terms of size 1 at most, each rounded to
/// 1e-31 of its size; an eigenvalue that is missing or found twice changes them by orders more than
/// this.
constexpr Real kTraceError = 1e-22;

/// The parts of the secular equation that are polynomials in s.
template <typename Scalar>
struct Polynomials {
  Scalar smooth, smooth_slope;  ///< N (2 lambda - 1) (N Q), and its derivative by lambda
  Scalar sharp, sharp_slope;    ///< (s / 2) (3/2 lambda - 1/4), and its derivative by s

  Polynomials(int faces, const Scalar& s) {
    using Number = RealOf<Scalar>;
    const Number n = static_cast<Number>(faces);
    const Scalar lambda = s * s;
    const Scalar q = n * lambda * lambda - (3 * n - 7) / 4 * lambda + (n - 3) / 16;
    const Scalar q_slope = 2 * n * lambda - (3 * n - 7) / 4;
    const Scalar factor = Number(2) * lambda - Number(1);
    smooth = n * factor * q;
    smooth_slope = n * (Number(2) * q + factor * q_slope);
    sharp = s * (Number(3) / 4 * lambda - Number(1) / 8);
    sharp_slope = Number(9) / 4 * lambda - Number(1) / 8;
  }
};

/// The difference of both sides of the secular equation, over the sign of sin(N psi) at the pole
/// from which the wave counts.
template <typename Scalar>
struct Secular {
  Scalar value, slope;  ///< and its derivative by delta

  Secular(int faces, const CircleWave<Scalar>& wave) {
    using Number = RealOf<Scalar>;
    const Number n = static_cast<Number>(faces);
    const Scalar s = wave.root();
    const Polynomials<Scalar> p(faces, s);
    const Scalar cos_1 = wave.first().cos, sin_1 = wave.first().sin;
    const SineCosine<Scalar> turn = sineCosine(n * wave.delta());
    const Scalar cos_n = -turn.sin, sin_n = turn.cos, ratio = sin_n / sin_1;
    value = p.smooth * cos_n - p.sharp * ratio;
    const Scalar s_slope = -sin_1 * s / (Number(4) * s - cos_1);
    slope = p.smooth_slope * Number(2) * s * s_slope * cos_n - n * p.smooth * sin_n -
            p.sharp_slope * s_slope * ratio - p.sharp * (n * cos_n - ratio * cos_1) / sin_1;
  }
};

/// Where `value` changes its sign between a and b, to the last bit of a double (bisection).
template <typename Value>
double signChange(double a, double b, const Value& value) {
  const bool rising = value(a) < 0;
  if (rising == (value(b) < 0)) {
    throw std::logic_error(
        "dart: the secular equation has no sign change where an eigenvalue is expected");
  }
  for (;;) {
    const double middle = (a + b) / 2;
    if (middle == a || middle == b) {
      return middle;
    }
    ((value(middle) < 0) == rising ? a : b) = middle;
  }
}

/// The solution of the secular equation near `delta`, by Newton's method.
template <typename Scalar>
CircleWave<Scalar> refined(int faces, int multiple, Scalar delta) {
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Secular<Scalar> at(faces, {faces, multiple, delta});
    delta -= at.value / at.slope;
  }
  return {faces, multiple, delta};
}

/// The odd multiple of pi / (2 N) at which pole k is.
int multipleOfPole(int k) { return 2 * k + 1; }

/// Whether psi = multiple pi / (2 N), which is midway between two poles, solves the secular
/// equation. sin(N psi) is 0 there, so that the other side has to be 0 as well: 2 lambda - 1 is 0
/// at psi = pi/4, which is midway where N is divisible by 4; N Q is 0 at N = 4, psi = pi/2, where
/// lambda is 1/4.
bool solvesMidway(int faces, int multiple) {
  return 2 * multiple == faces || (faces == 4 && multiple == 4);
}

/// The eigenvalue between poles k and k + 1, as a distance from the closer one. Where it is midway
/// between them rounding would decide on the sign that the secular equation has there.
CircleWave<Real> between(int faces, int k) {
  const int midway = multipleOfPole(k) + 1;
  if (solvesMidway(faces, midway)) {
    return {faces, midway, 0};
  }
  const double half = kPi<double> / (2. * faces);
  const auto from = [&](int pole) {
    return [=](double delta) {
      return Secular<double>(faces, {faces, multipleOfPole(pole), delta}).value;
    };
  };
  const bool left = (from(k)(0) < 0) != (from(k)(half) < 0);
  const int pole = left ? k : k + 1;
  return refined<Real>(faces, multipleOfPole(pole),
                       left ? signChange(0, half, from(pole)) : signChange(-half, 0, from(pole)));
}

/// The secular equation below the poles, where waves decay.
template <typename Scalar>
Scalar decayingSecular(int faces, const Scalar& lambda) {
  using std::sqrt;
  const Scalar n = faces;
  const Scalar d = lambda * lambda - 3 * lambda / 4 + Scalar(1) / 16;
  const Scalar q = n * d + 7 * lambda / 4 - Scalar(3) / 16;
  return n * (2 * lambda - 1) * q + (3 * lambda / 2 - Scalar(1) / 4) * lambda / (4 * sqrt(d)) *
                                        DecayingWave<Scalar>(faces, lambda).tangent();
}

/// The eigenvalue below those of the poles. -1/2 is below all eigenvalues; near the zero of D,
/// which is a root of the equation as well, the search ends in time.
Real lowestEigenvalue(int faces) {
  const double end = (3 - std::sqrt(5.)) / 8;  // D = 0
  const double guess = signChange(-0.5, end - 0.01 / faces, [=](double lambda) {
    return decayingSecular<double>(faces, lambda);
  });
  // The secant through two places beside it has its slope to 10 digits or more: each step gains
  // these.
  const Real beside = std::ldexp(1., -30);
  const Real slope = (decayingSecular<Real>(faces, guess + beside) -
                      decayingSecular<Real>(faces, guess - beside)) /
                     (2 * beside);
  Real lambda = guess;
  for (int i = 0; i < kSecantSteps; ++i) {
    lambda -= decayingSecular<Real>(faces, lambda) / slope;
  }
  return lambda;
}

/// The sums of all N + 2 eigenvalues and of their squares: those of the symmetric part of the
/// smooth ring, plus what the change u w^T of e_0's row adds: w u and 2 w S u + (w u)^2.
struct Traces {
  Real first, second;

  explicit Traces(int faces) {
    const Real n = static_cast<Real>(faces);
    const Real radial = Real(3) / 4 - 7 / (4 * n), radial_product = Real(1) / 16 - 3 / (16 * n);
    first = 1 + radial;
    second = 1 + radial * radial - 2 * radial_product;
    const Circle<Real> circle(faces);
    for (int m = 1; 2 * m < faces; ++m) {
      const Real sum = (5 + circle.cos(m)) / 8;
      first += sum;
      second += sum * sum - Real(1) / 8;
    }
    if (faces % 2 == 0) {
      first += Real(1) / 4;
      second += Real(1) / 16;
    }
    const Real w_u = Real(1) / 8;
    // At valence 2 the two neighbours of e_0 are the same point.
    const Real w_s_u = 3 / (16 * n * n) + Real(1) / 128 - (faces == 2 ? Real(1) / 128 : 0);
    first += w_u;
    second += 2 * w_s_u + w_u * w_u;
  }
};

/// The solution of the secular equation whose lambda is near this one.
CircleWave<Complex> refined(int faces, const Complex& lambda) {
  const std::complex<double> near(lambda.real().high(), lambda.imag().high());
  const std::complex<double> psi = std::acos((4. * near - 1.) / (2. * std::sqrt(near)));
  const double spacing = kPi<double> / faces;
  const int pole = std::clamp(static_cast<int>(std::floor(psi.real() / spacing)), 0, faces - 1);
  return refined<Complex>(faces, multipleOfPole(pole),
                          {psi.real() - (pole + 0.5) * spacing, psi.imag()});
}

/// All eigenvalues are real: the pair becomes the two closest ones of itself and the waves next to
/// it.
void pairClosest(int faces, std::vector<CircleWave<Real>>& waves,
                 std::vector<CircleWave<Complex>>& pair) {
  Real distance = abs(pair[0].lambda() - pair[1].lambda());
  int exchanged = -1, wave = -1;
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < static_cast<int>(waves.size()); ++k) {
      const Real other = abs(pair[i].lambda() - waves[k].lambda());
      if (other < distance) {
        distance = other;
        exchanged = 1 - i;
        wave = k;
      }
    }
  }
  if (wave >= 0) {
    const CircleWave<Real> joins = waves[wave];
    waves[wave] = {faces, pair[exchanged].multiple(), pair[exchanged].delta().real()};
    pair[exchanged] = {faces, joins.multiple(), joins.delta()};
  }
}

}  // namespace

DartSpectrum::DartSpectrum(int faces) : lowest(lowestEigenvalue(faces)) {
  const auto lambdaOfPole = [&](int k) {
    return CircleWave<Real>(faces, multipleOfPole(k), 0).lambda();
  };
  InterruptionStride stride;
  for (int k = 0; k + 1 < faces; ++k) {
    stride.step();
    if (lambdaOfPole(k) > kNoSignChange && lambdaOfPole(k + 1) < kNoSignChange) {
      continue;
    }
    waves.push_back(between(faces, k));
  }

  Traces left(faces);
  const auto take = [&](Real lambda) {
    left.first -= lambda;
    left.second -= lambda * lambda;
  };
  take(1);
  take(lowest);
  for (const CircleWave<Real>& wave : waves) {
    take(wave.lambda());
  }
  const Real mean = left.first / 2;
  const Complex half = sqrt(Complex(left.second / 2 - mean * mean));
  pair = {refined(faces, mean + half), refined(faces, mean - half)};

  const Complex sum = pair[0].lambda() + pair[1].lambda();
  const Complex squares = pair[0].lambda() * pair[0].lambda() + pair[1].lambda() * pair[1].lambda();
  if (static_cast<int>(waves.size()) != faces - 2 || !(abs(sum - left.first) < kTraceError) ||
      !(abs(squares - left.second) < kTraceError)) {
    throw std::logic_error("dart: the eigenvalues do not add up to the traces of the ring matrix");
  }

  if (half.imag() == 0) {
    pairClosest(faces, waves, pair);
  }
}

}  // namespace limitsurf
