// SPDX-License-Identifier: Apache-2.0
//
// What first-order conditions prove of closest points: the inequality of FootBound, on random
// patches and for random points.
#include "limitsurf/search/foot_bound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace limitsurf::test {
namespace {

/// A patch that differs from a parallelogram by `bend`.
BezierPatch bentPatch(double bend, Random& random) {
  const Vector3 along = random.vector(1), across = random.vector(1);
  BezierPatch patch;
  patch.anchor.setZero();
  for (int i = 0; i < 16; ++i) {
    const Vector3 at = (i % 4) / 3. * along + (i / 4) / 3. * across + random.vector(bend);
    patch.points[i] << at[0], at[1], at[2], 0;
  }
  return patch;
}

Vector3 at(const BezierPatch::Point& p) { return p.head<3>().matrix(); }

TEST(FootBound, DistancesLieAboveTheirTangentPlanes) {
  Random random(1);
  int by_radius = 0, by_direction = 0;
  for (int round = 0; round < 3000; ++round) {
    const BezierPatch patch = bentPatch(std::pow(10., random.uniform(-4, -0.5)), random);
    const FootBound bound(patch);
    for (int place = 0; place < 5; ++place) {
      const double s = random.uniform(), t = random.uniform();
      BezierPatch::Values x;
      patch.evaluate<1>(s, t, x);
      const Vector3 direction = random.vector(1).normalized();
      const double distance = std::pow(10., random.uniform(-3, 2));
      double z[16];
      for (int i = 0; i < 16; ++i) z[i] = at(patch.points[i]).dot(direction);
      const bool near = distance <= bound.radius;
      if (!near && !bound.holds(z, distance)) continue;
      ++(near ? by_radius : by_direction);
      const Vector3 point = at(x.value) - distance * direction;
      const Vector3 away = at(x.value) - point;
      const double gs = away.dot(at(x.ds)), gt = away.dot(at(x.dt));
      for (int other = 0; other < 30; ++other) {
        const double s1 = random.below(4) ? random.uniform() : random.below(2),
                     t1 = random.below(4) ? random.uniform() : random.below(2);
        BezierPatch::Values y;
        patch.evaluate<0>(s1, t1, y);
        EXPECT_GE((at(y.value) - point).squaredNorm(), away.squaredNorm() +
                                                           2 * (gs * (s1 - s) + gt * (t1 - t)) -
                                                           1e-13 * (1 + away.squaredNorm()));
      }
    }
  }
  EXPECT_GT(by_radius, 2000);
  EXPECT_GT(by_direction, 300);
}

TEST(FootBound, APlaneIsBoundedFromAllDistances) {
  Random random(2);
  for (int round = 0; round < 100; ++round) {
    EXPECT_GT(FootBound(bentPatch(0, random)).radius, 1e6);
  }
}

TEST(FootBound, NothingIsSaidOfPatchesWithoutArea) {
  BezierPatch patch;
  for (BezierPatch::Point& point : patch.points) point.setZero();
  EXPECT_EQ(FootBound(patch).stretch, 0);
  for (int i = 0; i < 16; ++i) patch.points[i][0] = i;
  EXPECT_EQ(FootBound(patch).stretch, 0);
  const double z[16] = {};
  EXPECT_FALSE(FootBound(patch).holds(z, 0.1));
}

}  // namespace
}  // namespace limitsurf::test
