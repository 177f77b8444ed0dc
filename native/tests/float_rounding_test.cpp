// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/float_rounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "support/random.h"

namespace limitsurf::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kSmallest = std::numeric_limits<float>::denorm_min();

/// Checks that no float lies between the bounds of a number and the number.
void expectTight(double value) {
  const float up = roundedUp(value), down = roundedDown(value);
  EXPECT_GE(double{up}, value);
  EXPECT_LT(double{std::nextafter(up, -kInfinity)}, value);
  EXPECT_LE(double{down}, value);
  EXPECT_GT(double{std::nextafter(down, kInfinity)}, value);
}

TEST(FloatRounding, BoundsAreTheNearestFloats) {
  Random random(1);
  for (int round = 0; round < 100000; ++round) {
    const double value = std::ldexp(random.uniform(-1, 1), random.below(270) - 145);
    if (value != 0) expectTight(value);
  }
  for (const double value : {1., -1., 0.1, -0.1, double{kLargest}, -double{kLargest}, 1e-60, -1e-60,
                             double{kSmallest}, -double{kSmallest}, 1.5 * kSmallest}) {
    expectTight(value);
  }
}

TEST(FloatRounding, TheEndsOfTheRange) {
  EXPECT_EQ(roundedUp(0), 0);
  EXPECT_EQ(roundedDown(0), 0);
  EXPECT_EQ(roundedUp(1e300), kInfinity);
  EXPECT_EQ(roundedDown(1e300), kLargest);
  EXPECT_EQ(roundedUp(-1e300), -kLargest);
  EXPECT_EQ(roundedDown(-1e300), -kInfinity);
  EXPECT_EQ(roundedUp(std::numeric_limits<double>::infinity()), kInfinity);
  EXPECT_TRUE(std::isnan(roundedUp(std::nan(""))));
}

}  // namespace
}  // namespace limitsurf::test
