// SPDX-License-Identifier: Apache-2.0
//
// The squared distance of a patch as a polynomial, and its parts.
#include "limitsurf/search/squared_distance.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace limitsurf::test {
namespace {

using Division = SquaredDistance::Division;

BezierPatch randomPatch(Random& random) {
  BezierPatch patch;
  patch.anchor.setZero();
  for (BezierPatch::Point& point : patch.points) {
    point = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0};
  }
  return patch;
}

double squaredDistance(const BezierPatch& patch, double s, double t) {
  BezierPatch::Values at;
  patch.evaluate<0>(s, t, at);
  return dot(at.value, at.value);
}

TEST(SquaredDistance, PartsAreThoseOfThePatch) {
  Random random(1);
  const Division divisions[] = {Division::both, Division::s, Division::t};
  for (int round = 0; round < 60; ++round) {
    const BezierPatch patch = randomPatch(random);
    const Division along = divisions[round % 3];
    SquaredDistance parts[4];
    SquaredDistance(SearchKernels::get(), patch.points, BezierPatch::Point::Zero())
        .divide(along, parts);
    const double s_size = along == Division::t ? 1 : 0.5, t_size = along == Division::s ? 1 : 0.5;
    for (int q = 0; q < 4; ++q) {
      const double s0 = (q & 1) * s_size, t0 = (q >> 1) * t_size;
      if (s0 == 1 || t0 == 1) {
        continue;  // no part
      }
      for (int corner = 0; corner < 4; ++corner) {
        EXPECT_NEAR(parts[q].corner(corner & 1, corner >> 1),
                    squaredDistance(patch, s0 + (corner & 1) * s_size, t0 + (corner >> 1) * t_size),
                    1e-14);
      }
      for (int place = 0; place < 20; ++place) {
        const double squared =
            squaredDistance(patch, s0 + s_size * random.uniform(), t0 + t_size * random.uniform());
        EXPECT_GE(squared, parts[q].least() - 1e-14);
        EXPECT_LE(squared, parts[q].magnitude() + 1e-14);
      }
    }
  }
}

/// Where a patch is long along s, second differences along s are the larger ones.
TEST(SquaredDistance, BendsTellAlongWhichParameterAPatchIsLong) {
  for (const bool along_s : {true, false}) {
    BezierPatch patch;
    patch.anchor.setZero();
    for (int i = 0; i < 16; ++i) {
      const double s = i % 4 / 3., t = i / 4 / 3.;
      patch.points[i] = {along_s ? 10 * s : s, along_s ? t : 10 * t, 1, 0};
    }
    const SquaredDistance::Shape shape =
        SquaredDistance(SearchKernels::get(), patch.points, BezierPatch::Point::Zero()).shape(0);
    // |P|^2 = 100 s^2 + t^2 + 1; a square has second differences of 2 / (6 * 5).
    EXPECT_NEAR(along_s ? shape.s_bend : shape.t_bend, 100 / 15., 1e-12);
    EXPECT_NEAR(along_s ? shape.t_bend : shape.s_bend, 1 / 15., 1e-12);
  }
}

}  // namespace
}  // namespace limitsurf::test
