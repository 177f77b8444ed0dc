// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limitsurf/pi.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

constexpr double kTurn = 2 * kPi<double>;

Point2 direction(double angle) { return {3 * std::cos(angle), 3 * std::sin(angle)}; }

BorderFind find(double begin, double width) {
  const Wedge wedge{direction(begin), direction(begin + width)};
  return {0, 1, {wedge, wedge}};
}

bool overlap(const std::vector<BorderFind>& finds) {
  WedgeOverlap test;
  return test.of(finds.data(), finds.data() + finds.size());
}

TEST(WedgeOverlap, NeighboursAroundAPointOnlyTouch) {
  for (const int count : {2, 3, 4, 7, 64, 512}) {
    std::vector<BorderFind> finds;
    for (int i = 0; i < count; ++i) {
      finds.push_back(find(kTurn * (i * 5 % count) / count + 0.3, kTurn / count));
    }
    EXPECT_FALSE(overlap(finds)) << count;
    // One more anywhere lies on the others.
    for (const double at : {0.1, 3.0, 5.5}) {
      std::vector<BorderFind> more = finds;
      more.push_back(find(at, 0.01));
      EXPECT_TRUE(overlap(more)) << count << " " << at;
    }
  }
}

TEST(WedgeOverlap, AgreesWithComparingAllPairs) {
  Random random(4);
  int overlaps = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const int count = 2 + random.below(5);
    std::vector<double> begins, widths;
    std::vector<BorderFind> finds;
    for (int i = 0; i < count; ++i) {
      begins.push_back(random.uniform(0, kTurn));
      widths.push_back(random.uniform(0.01, 0.5 * kTurn / count));
      finds.push_back(find(begins.back(), widths.back()));
    }
    bool expected = false, unclear = false;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const double from = std::fmod(begins[j] - begins[i] + kTurn, kTurn);
        expected |= i != j && from < widths[i] - 1e-3;
        unclear |= i != j && std::abs(from - widths[i]) <= 1e-3;
      }
    }
    if (!unclear) {
      ASSERT_EQ(overlap(finds), expected) << trial;
      overlaps += expected;
    }
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_LT(overlaps, 3500);
}

TEST(WedgeOverlap, WedgesOfOneFindAreNotCompared) {
  BorderFind both = find(0, 1);
  both.wedge_count = 2;
  EXPECT_FALSE(overlap({both}));
  EXPECT_FALSE(overlap({both, find(2, 1)}));
  EXPECT_TRUE(overlap({both, find(0.5, 1)}));
}

}  // namespace
}  // namespace limitsurf::test
