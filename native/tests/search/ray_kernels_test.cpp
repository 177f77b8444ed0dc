// SPDX-License-Identifier: Apache-2.0
//
// The kernels of searches along rays: what they compute, and that all instruction sets give the
// same bits.
#include "limitsurf/search/rays/ray_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// A patch that is nearly a plane across the ray, with the ray at (s, t).
struct SeenPatch {
  SeenPatch(Random& random, double bend, double s, double t) {
    const double xs = random.uniform(-1, 1), xt = random.uniform(-1, 1), ys = random.uniform(-1, 1),
                 yt = random.uniform(-1, 1);
    for (int i = 0; i < 16; ++i) {
      const double ds = (i & 3) / 3. - s, dt = (i >> 2) / 3. - t;
      x[i] = xs * ds + xt * dt + random.uniform(-bend, bend);
      y[i] = ys * ds + yt * dt + random.uniform(-bend, bend);
      z[i] = 3 + random.uniform(-bend, bend);
    }
    // The sine of the angle between the derivatives
    sine = std::abs(xs * yt - xt * ys) / (std::hypot(xs, ys) * std::hypot(xt, yt));
  }
  double x[16], y[16], z[16], sine;
};

double bernstein(int i, double t) {
  constexpr double kBinomial[4] = {1, 3, 3, 1};
  return kBinomial[i] * std::pow(t, i) * std::pow(1 - t, 3 - i);
}

double bernsteinSlope(int i, double t) {
  const auto quadratic = [&](int k) {
    return k < 0 || k > 2 ? 0 : (k == 1 ? 2 : 1) * std::pow(t, k) * std::pow(1 - t, 2 - k);
  };
  return 3 * (quadratic(i - 1) - quadratic(i));
}

/// A sum over the coefficients with weights for i and j.
template <typename ByS, typename ByT>
double sum(const double f[16], const ByS& by_s, const ByT& by_t) {
  double result = 0;
  for (int k = 0; k < 16; ++k) result += by_s(k & 3) * by_t(k >> 2) * f[k];
  return result;
}

TEST(RayKernels, SeeIsTheChangeOfCoordinates) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    double points[16][4], axes[3][4], offset[3], seen[3][16];
    for (auto& point : points) {
      for (double& number : point) number = random.uniform(-1, 1);
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (double& number : axes[axis]) number = random.uniform(-1, 1);
      offset[axis] = random.uniform(-5, 5);
    }
    RayKernels::get().see(points, axes, offset, seen[0], seen[1], seen[2]);
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 16; ++i) {
        double truth = offset[axis];  // the fourth numbers do not count
        for (int j = 0; j < 3; ++j) truth += points[i][j] * axes[axis][j];
        EXPECT_NEAR(seen[axis][i], truth, 1e-14);
      }
    }
  }
}

TEST(RayKernels, ValuesAndDerivativesAreThoseOfTheBernsteinForm) {
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const SeenPatch patch(random, 1, 0.5, 0.5);
    const double s = random.uniform(), t = random.uniform();
    OffsetFromRay offset;
    PlaceAlongRay place;
    RayKernels::get().offset(patch.x, patch.y, s, t, offset);
    RayKernels::get().place(patch.z, s, t, place);
    const auto value_s = [&](int i) { return bernstein(i, s); };
    const auto value_t = [&](int i) { return bernstein(i, t); };
    const auto slope_s = [&](int i) { return bernsteinSlope(i, s); };
    const auto slope_t = [&](int i) { return bernsteinSlope(i, t); };
    EXPECT_NEAR(offset.x, sum(patch.x, value_s, value_t), 1e-14);
    EXPECT_NEAR(offset.y, sum(patch.y, value_s, value_t), 1e-14);
    EXPECT_NEAR(place.z, sum(patch.z, value_s, value_t), 1e-14);
    EXPECT_NEAR(offset.xs, sum(patch.x, slope_s, value_t), 1e-13);
    EXPECT_NEAR(offset.ys, sum(patch.y, slope_s, value_t), 1e-13);
    EXPECT_NEAR(place.zs, sum(patch.z, slope_s, value_t), 1e-13);
    EXPECT_NEAR(offset.xt, sum(patch.x, value_s, slope_t), 1e-13);
    EXPECT_NEAR(offset.yt, sum(patch.y, value_s, slope_t), 1e-13);
    EXPECT_NEAR(place.zt, sum(patch.z, value_s, slope_t), 1e-13);
  }
}

/// The least of |offset|, found on a fine grid.
double leastOffset(const SeenPatch& patch) {
  constexpr int kSteps = 64;
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      OffsetFromRay at;
      RayKernels::get().offset(patch.x, patch.y, 1. * i / kSteps, 1. * j / kSteps, at);
      least = std::min(least, std::sqrt(at.squared()));
    }
  }
  return least;
}

constexpr RayLimits kLimits = {0, 10, 1e-14, 1e-13};

RayMeeting meet(const SeenPatch& patch, const RayLimits& limits = kLimits) {
  return RayKernels::get().meet(patch.x, patch.y, patch.z, limits);
}

TEST(RayKernels, APatchWithARootIsNeverMissed) {
  Random random(3);
  int once = 0;
  for (int round = 0; round < 2000; ++round) {
    const double s = random.uniform(), t = random.uniform(), bend = 0.1 * random.uniform();
    SeenPatch patch(random, bend, s, t);
    OffsetFromRay at;  // is moved to the ray
    RayKernels::get().offset(patch.x, patch.y, s, t, at);
    for (int i = 0; i < 16; ++i) {
      patch.x[i] -= at.x;
      patch.y[i] -= at.y;
    }
    const RayMeeting meeting = meet(patch);
    EXPECT_NE(meeting, RayMeeting::none) << round;
    once += meeting == RayMeeting::once_at_most;
  }
  EXPECT_GT(once, 1000);  // or all would be divided
}

TEST(RayKernels, MissedPatchesHaveNoRoot) {
  Random random(4);
  int missed = 0;
  for (int round = 0; round < 500; ++round) {
    const SeenPatch patch(random, 0.05, random.uniform(-2, 3), random.uniform(-2, 3));
    if (meet(patch) == RayMeeting::none) {
      ++missed;
      EXPECT_GT(leastOffset(patch), 0) << round;
    } else if (patch.sine > 0.5) {  // the hull of such a patch is close to it
      EXPECT_LT(leastOffset(patch), 0.3) << round;
    }
  }
  EXPECT_GT(missed, 300);
}

TEST(RayKernels, APatchThatMeetsTheRayOnceIsSeenWithoutFolds) {
  Random random(5);
  int once = 0;
  for (int round = 0; round < 500; ++round) {
    const SeenPatch patch(random, 0.1 * random.uniform(), random.uniform(), random.uniform());
    if (meet(patch) != RayMeeting::once_at_most) continue;
    ++once;
    double sign = 0;
    for (int j = 0; j <= 20; ++j) {
      for (int i = 0; i <= 20; ++i) {
        OffsetFromRay at;
        RayKernels::get().offset(patch.x, patch.y, i / 20., j / 20., at);
        const double determinant = at.xs * at.yt - at.xt * at.ys;
        if (sign == 0) sign = determinant > 0 ? 1 : -1;
        EXPECT_GT(sign * determinant, 0) << round;
      }
    }
  }
  EXPECT_GT(once, 100);
}

TEST(RayKernels, LimitsDecide) {
  Random random(6);
  SeenPatch patch(random, 0, 0.5, 0.5);
  EXPECT_EQ(meet(patch), RayMeeting::once_at_most);
  EXPECT_EQ(meet(patch, {3.5, 10, 1e-14, 1e-13}), RayMeeting::none);
  EXPECT_EQ(meet(patch, {0, 2.5, 1e-14, 1e-13}), RayMeeting::none);
  EXPECT_EQ(meet(patch, {3, 3, 1e-14, 1e-13}), RayMeeting::once_at_most);
  EXPECT_EQ(meet(patch, {0, 10, 1e-14, 10}), RayMeeting::everywhere);
  std::copy_n(patch.x, 16, patch.y);  // seen as a line
  EXPECT_EQ(meet(patch), RayMeeting::unknown);
  std::fill_n(patch.x, 16, 1e-12);
  EXPECT_EQ(meet(patch), RayMeeting::none);
  EXPECT_EQ(meet(patch, {0, 10, 1e-12, 1e-11}), RayMeeting::unknown);
}

TEST(RayKernels, AllInstructionSetsGiveTheSameBits) {
  const InstructionSet before = instructionSet();
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    const double s = random.uniform(), t = random.uniform();
    const SeenPatch patch(random, 0.3 * random.uniform(), s, t);
    double points[16][4], axes[3][4];
    for (int i = 0; i < 16; ++i) {
      const double point[4] = {patch.x[i], patch.y[i], patch.z[i], 0};
      std::copy_n(point, 4, points[i]);
    }
    for (auto& axis : axes) {
      for (double& number : axis) number = random.uniform(-1, 1);
    }
    struct Results {
      double seen[3][16];
      OffsetFromRay offset;
      PlaceAlongRay place;
      double meeting;
    } results[3];
    int count = 0;
    for (const InstructionSet set :
         {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!isAvailable(set)) continue;
      useInstructionSet(set);
      Results& result = results[count++];
      const RayKernels& kernels = RayKernels::get();
      kernels.see(points, axes, axes[0], result.seen[0], result.seen[1], result.seen[2]);
      kernels.offset(patch.x, patch.y, s, t, result.offset);
      kernels.place(patch.z, s, t, result.place);
      result.meeting = static_cast<double>(meet(patch));
      EXPECT_EQ(std::memcmp(&result, &results[0], sizeof result), 0);
    }
  }
  useInstructionSet(before);
}

}  // namespace
}  // namespace limitsurf::test
