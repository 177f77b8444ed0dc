// SPDX-License-Identifier: Apache-2.0
//
// The kernels of searches: what they compute, and that all instruction sets give the same bits.
#include "limitsurf/search/search_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "limitsurf/bernstein.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

struct RandomPatch {
  explicit RandomPatch(Random& random) {
    for (auto& point : points) {
      for (int axis = 0; axis < 4; ++axis) point[axis] = axis < 3 ? random.uniform(-1, 1) : 0;
    }
    for (int axis = 0; axis < 3; ++axis) away[axis] = random.below(2) * random.uniform(-100, 100);
  }
  double points[16][4];
  double away[4] = {0, 0, 0, 0};
};

double bernstein(int degree, int i, double t) {
  double value = 1;
  for (int k = 0; k < i; ++k) value *= t * (degree - k) / (k + 1);
  for (int k = i; k < degree; ++k) value *= 1 - t;
  return value;
}

TEST(SearchKernels, ThePolynomialIsTheSquaredDistance) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const RandomPatch patch(random);
    double c[kDistanceSize];
    SearchKernels::get().squaredDistance(patch.points, patch.away, c);
    for (int place = 0; place < 5; ++place) {
      const double s = random.uniform(), t = random.uniform();
      double at[6][4], sum = 0, direct = 0;
      SearchKernels::get().evaluate(patch.points, s, t, at);
      for (int axis = 0; axis < 3; ++axis) {
        double value = 0;
        for (int k = 0; k < 16; ++k) {
          value += bernstein(3, k % 4, s) * bernstein(3, k / 4, t) * patch.points[k][axis];
        }
        EXPECT_NEAR(at[0][axis], value, 1e-14);
        direct += value * (value - 2 * patch.away[axis]);
      }
      for (int j = 0; j < 7; ++j) {
        for (int i = 0; i < 7; ++i) {
          sum += bernstein(6, i, s) * bernstein(6, j, t) * c[kDistanceStride * j + i];
        }
      }
      EXPECT_NEAR(sum, direct, 1e-12);
    }
  }
}

TEST(SearchKernels, MovedPointsLieInABoxNoNearerThanTold) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    const RandomPatch patch(random);
    const double offset[4] = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5),
                              0};
    double moved[16][4];
    const double least = SearchKernels::get().move(patch.points, offset, patch.away, moved);
    double of_box = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int i = 0; i < 16; ++i) {
        EXPECT_EQ(moved[i][axis], patch.points[i][axis] + offset[axis]);
        low = std::min(low, moved[i][axis]);
        high = std::max(high, moved[i][axis]);
      }
      const double nearest = std::clamp(patch.away[axis], low, high);
      of_box += (nearest - patch.away[axis]) * (nearest - patch.away[axis]) -
                patch.away[axis] * patch.away[axis];
    }
    EXPECT_NEAR(least, of_box, 1e-11);
  }
}

TEST(SearchKernels, BoundsAreTheExtremesOfTheDifferences) {
  Random random(2);
  const auto at = [](const double* c, int i, int j) { return c[kDistanceStride * j + i]; };
  for (int round = 0; round < 50; ++round) {
    const RandomPatch patch(random);
    double c[kDistanceSize];
    SearchKernels::get().squaredDistance(patch.points, patch.away, c);
    DifferenceBounds found;
    SearchKernels::get().differenceBounds(c, found);
    double least, largest;
    SearchKernels::get().extremes(c, least, largest);
    double low[6], high[6];
    std::fill_n(low, 6, std::numeric_limits<double>::infinity());
    std::fill_n(high, 6, -low[0]);
    const auto include = [&](int kind, double value) {
      low[kind] = std::min(low[kind], value);
      high[kind] = std::max(high[kind], value);
    };
    for (int j = 0; j < 7; ++j) {
      for (int i = 0; i < 7; ++i) {
        const double here = at(c, i, j);
        include(0, here);
        if (i < 6) include(1, at(c, i + 1, j) - here);
        if (j < 6) include(2, at(c, i, j + 1) - here);
        if (i < 5) include(3, here - 2 * at(c, i + 1, j) + at(c, i + 2, j));
        if (j < 5) {
          include(4, (at(c, i, j + 2) - at(c, i, j + 1)) - (at(c, i, j + 1) - here));
        }
        if (i < 6 && j < 6) {
          include(5, (at(c, i + 1, j + 1) - at(c, i, j + 1)) - (at(c, i + 1, j) - here));
        }
      }
    }
    const double pairs[6][2] = {{least, largest},
                                {found.least_s, found.largest_s},
                                {found.least_t, found.largest_t},
                                {found.least_ss, found.largest_ss},
                                {found.least_tt, found.largest_tt},
                                {found.least_st, found.largest_st}};
    for (int kind = 0; kind < 6; ++kind) {
      EXPECT_EQ(pairs[kind][0], low[kind]) << kind;
      EXPECT_EQ(pairs[kind][1], high[kind]) << kind;
    }
  }
}

TEST(SearchKernels, AllInstructionSetsGiveTheSameBits) {
  const InstructionSet before = instructionSet();
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    const RandomPatch patch(random);
    const double s = random.uniform(), t = random.uniform();
    struct {
      double polynomial[kDistanceSize], extremes[2], values[6][4], along[16], moved[16][4], least;
      DifferenceBounds bounds;
    } results[3];
    int count = 0;
    for (const InstructionSet set :
         {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!isAvailable(set)) continue;
      useInstructionSet(set);
      auto& result = results[count++];
      SearchKernels::get().squaredDistance(patch.points, patch.away, result.polynomial);
      SearchKernels::get().differenceBounds(result.polynomial, result.bounds);
      SearchKernels::get().extremes(result.polynomial, result.extremes[0], result.extremes[1]);
      SearchKernels::get().evaluate(patch.points, s, t, result.values);
      SearchKernels::get().along(patch.points, patch.away, result.along);
      result.least =
          SearchKernels::get().move(patch.points, patch.away, patch.points[0], result.moved);
      for (int i = 0; i < 16; ++i) {
        const double* p = patch.points[i];
        const double* a = patch.away;
        EXPECT_EQ(result.along[i], p[0] * a[0] + p[1] * a[1] + p[2] * a[2]);
      }
      EXPECT_EQ(std::memcmp(&result, &results[0], sizeof result), 0);
    }
  }
  useInstructionSet(before);
}

}  // namespace
}  // namespace limitsurf::test
