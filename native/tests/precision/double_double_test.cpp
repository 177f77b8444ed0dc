// SPDX-License-Identifier: Apache-2.0
//
// The arithmetic of double-doubles, against numbers of 300 digits, whose sums and products of
// doubles are exact.
#include "limitsurf/precision/double_double.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "limitsurf/precision/complex.h"
#include "limitsurf/precision/double_double_eigen.h"
#include "limitsurf/precision/elementary.h"
#include "limitsurf/precision/sum_of_products.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

using Big = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<300>,
                                          boost::multiprecision::et_off>;

constexpr double kUnit = 0x1p-53;
constexpr int kTrials = 5000;

Big exact(const DoubleDouble& a) { return Big(a.high()) + Big(a.low()); }

/// |got - expected| <= bound |size|.
void expectWithin(const DoubleDouble& got, const Big& expected, double bound, const Big& size,
                  const char* what) {
  EXPECT_EQ(got.high() + got.low(), got.high()) << what;  // the first part is the rounded sum
  EXPECT_LE(abs(Big(exact(got) - expected)), Big(bound) * abs(size)) << what;
}

double randomDouble(Random& random) {
  const double size = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.below(60)) - 30);
  return random.below(2) ? size : -size;
}

/// Both parts have all of their digits, and the second one is now and then much smaller than the
/// rounding of the first, or 0.
DoubleDouble randomNumber(Random& random) {
  const double high = randomDouble(random);
  const std::uint64_t kind = random.below(8);
  if (kind == 0) return high;
  const double scale = kind == 1 ? 0x1p-40 : 1;
  const Rounded sum = fastTwoSum(high, high * kUnit * scale * random.uniform(-1, 1));
  return DoubleDouble::ofParts(sum.value, sum.error);
}

TEST(DoubleDouble, ErrorFreeTransformationsAreExact) {
  Random random(1);
  for (int i = 0; i < kTrials; ++i) {
    const double a = randomDouble(random), b = randomDouble(random);
    const Rounded sum = twoSum(a, b), product = twoProduct(a, b);
    EXPECT_EQ(Big(sum.value) + Big(sum.error), Big(a) + Big(b));
    EXPECT_EQ(Big(product.value) + Big(product.error), Big(a) * Big(b));
    EXPECT_EQ(sum.value, a + b);
    EXPECT_EQ(product.value, a * b);
  }
}

TEST(DoubleDouble, OperationsKeepTheirBounds) {
  const double square = kUnit * kUnit;
  Random random(2);
  for (int i = 0; i < kTrials; ++i) {
    const DoubleDouble a = randomNumber(random);
    DoubleDouble b = randomNumber(random);
    if (random.below(4) == 0) b = -a.times(1 + 0x1p-20 * random.uniform());  // cancellation
    const double c = randomDouble(random);
    const Big ea = exact(a), eb = exact(b), ec = c;
    const auto expect = [&](const DoubleDouble& got, const Big& value, double bound,
                            const char* what) {
      expectWithin(got, value, bound * square, value, what);
    };
    expect(a + b, ea + eb, 3.0001, "a + b");
    expect(a - b, ea - eb, 3.0001, "a - b");
    expect(a * b, ea * eb, 5, "a * b");
    expect(a / b, ea / eb, 16, "a / b");
    expect(a.plus(c), ea + ec, 2, "a + double");
    expect(a.times(c), ea * ec, 1.50001, "a * double");
  }
}

TEST(DoubleDouble, SquareRootsKeepTheirBound) {
  Random random(3);
  for (int i = 0; i < kTrials; ++i) {
    const DoubleDouble a = abs(randomNumber(random));
    const Big expected = sqrt(exact(a));
    EXPECT_LE(abs(Big(exact(sqrt(a)) - expected)), 3.1251 * kUnit * kUnit * expected);
  }
  EXPECT_EQ(sqrt(DoubleDouble(0)), DoubleDouble(0));
  EXPECT_EQ(sqrt(DoubleDouble(9)), DoubleDouble(3));
}

TEST(DoubleDouble, ComparesBothParts) {
  const DoubleDouble one = 1, more = DoubleDouble::ofParts(1, 0x1p-80), less = one - 0x1p-80;
  EXPECT_LT(one, more);
  EXPECT_LT(less, one);
  EXPECT_LE(one, one);
  EXPECT_GT(more, less);
  EXPECT_GE(more, one);
  EXPECT_NE(one, more);
  EXPECT_EQ(abs(-more), more);
  EXPECT_FALSE(DoubleDouble(std::nan("")) == DoubleDouble(std::nan("")));
  EXPECT_FALSE(DoubleDouble(std::nan("")) < one);
}

TEST(DoubleDouble, HoldsIntegersExactly) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-7}, (std::int64_t{1} << 53) + 1,
        -(std::int64_t{1} << 60) - 1, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min()}) {
    EXPECT_EQ(exact(DoubleDouble(value)), Big(value)) << value;
  }
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(exact(DoubleDouble(most)), Big(most));
}

TEST(DoubleDouble, SumsOfProductsKeepTheirBound) {
  Random random(4);
  for (int i = 0; i < kTrials / 10; ++i) {
    const int count = 1 + static_cast<int>(random.below(25));
    SumOfProducts sum;
    Big expected, size;
    for (int j = 0; j < count; ++j) {
      const DoubleDouble a = randomNumber(random);
      const DoubleDouble b = j % 2 ? DoubleDouble(randomDouble(random)) : randomNumber(random);
      if (j % 2) {
        sum.add(a, b.high());
      } else {
        sum.add(a, b);
      }
      expected += exact(a) * exact(b);
      size += abs(Big(exact(a) * exact(b)));
    }
    expectWithin(sum.sum(), expected, (count + 6) * (count + 2) * kUnit * kUnit, size, "sum");
  }
}

TEST(DoubleDouble, SinesAndCosinesKeepTheirBounds) {
  Random random(5);
  double worst = 0;
  for (int i = 0; i < kTrials; ++i) {
    const double range = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 4 : 1000;
    const DoubleDouble x = DoubleDouble(range * random.uniform(-1, 1)) + 1e-17 * random.uniform();
    const Big exact_sin = sin(exact(x)), exact_cos = cos(exact(x));
    const SineCosine<DoubleDouble> got = sineCosine(x);
    const Big allowed = 2e-31 * (1 + abs(exact(x)));
    EXPECT_LE(abs(Big(exact(got.sin) - exact_sin)), allowed) << x.high();
    EXPECT_LE(abs(Big(exact(got.cos) - exact_cos)), allowed) << x.high();
    if (std::abs(x.high()) < 0.098) {
      const Big error = abs(Big(exact(got.sin) - exact_sin)) / abs(exact_sin);
      worst = std::max(worst, static_cast<double>(error));
    }
  }
  EXPECT_LE(worst, 2e-31);
  EXPECT_EQ(sineCosine(DoubleDouble(0)).sin, DoubleDouble(0));
  EXPECT_EQ(sineCosine(DoubleDouble(0)).cos, DoubleDouble(1));
}

TEST(SlowDoubleDouble, HyperbolicSinesAndCosinesKeepTheirBounds) {
  Random random(6);
  for (int i = 0; i < kTrials; ++i) {
    const double range = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 2 : 50;
    const DoubleDouble x = DoubleDouble(range * random.uniform(-1, 1)) + 1e-17 * random.uniform();
    const HyperbolicSineCosine got = hyperbolicSineCosine(x);
    const double allowed = 2e-31 * (1 + 4 * std::abs(x.high()));
    EXPECT_LE(abs(Big(exact(got.sinh) / sinh(exact(x)) - 1)), allowed) << x.high();
    EXPECT_LE(abs(Big(exact(got.cosh) / cosh(exact(x)) - 1)), allowed) << x.high();
  }
}

double sizeOf(const Complex& a) { return abs(a).high(); }

TEST(DoubleDouble, ComplexNumbersFollowTheirRules) {
  Random random(7);
  const auto number = [&] {
    return DoubleDouble(random.uniform(-2, 2)) + 1e-17 * random.uniform();
  };
  for (int i = 0; i < kTrials / 10; ++i) {
    const Complex a(number(), number()), b(number(), number());
    EXPECT_LE(sizeOf(a * b / b - a), 1e-29 * (1 + sizeOf(a) / sizeOf(b)));
    EXPECT_LE(sizeOf(sqrt(a) * sqrt(a) - a), 1e-30);
    EXPECT_GE(sqrt(a).real(), DoubleDouble(0));
    const SineCosine<Complex> of_a = sineCosine(a), of_b = sineCosine(b),
                              of_sum = sineCosine(a + b);
    EXPECT_LE(sizeOf(of_a.sin * of_b.cos + of_a.cos * of_b.sin - of_sum.sin), 1e-28);
    EXPECT_LE(sizeOf(of_a.cos * of_b.cos - of_a.sin * of_b.sin - of_sum.cos), 1e-28);
  }
  EXPECT_EQ(sizeOf(sqrt(Complex(-4)) - Complex(0, 2)), 0);
  EXPECT_EQ(sizeOf(sqrt(Complex(0))), 0);
}

TEST(DoubleDouble, ServesAsAnElementOfMatrices) {
  using Matrix = Eigen::Matrix<DoubleDouble, 7, 7>;
  Matrix hilbert;  // its condition number is 5e8
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) hilbert(i, j) = DoubleDouble(1) / (i + j + 1);
  }
  const Matrix product = hilbert * hilbert.fullPivLu().inverse();
  EXPECT_LE((product - Matrix::Identity()).cast<double>().cwiseAbs().maxCoeff(), 1e-21);
}

}  // namespace
}  // namespace limitsurf::test
