// SPDX-License-Identifier: Apache-2.0
//
// Cones of normals contain what they were made of.
#include "limitsurf/search/normals/normal_cones.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/pi.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

double angleBetween(const Vector3& a, const Vector3& b) {
  return 2 * std::atan2((a - b).norm(), (a + b).norm());
}

/// A direction at an angle from an axis.
Vector3 turned(const Vector3& axis, double angle, Random& random) {
  const Vector3 across = axis.cross(random.vector(1)).normalized();
  return std::cos(angle) * axis + std::sin(angle) * across;
}

/// Two cones whose axes are parallel or opposite but for little or nothing: their common cone has
/// a direction that rounding must not choose.
TEST(NormalCones, TheConeAroundTwoContainsBoth) {
  Random random(1);
  for (int round = 0; round < 4000; ++round) {
    NormalCone a, b;
    a.axis = random.vector(1).normalized();
    a.angle = random.uniform(0, 1.5) * random.below(2);
    const double off = random.below(4) == 0 ? 0 : std::pow(10., random.uniform(-17, 0));
    b.axis = turned(random.below(2) == 0 ? a.axis : Vector3(-a.axis), off, random).normalized();
    b.angle = random.uniform(0, 1.5) * random.below(2);
    const NormalCone both = NormalCone::around(a, b);
    for (const NormalCone& cone : {a, b}) {
      for (const double part : {0., 0.5, 1.}) {
        const Vector3 inside = turned(cone.axis, part * cone.angle, random);
        EXPECT_LE(angleBetween(both.axis, inside), both.angle + 1e-7) << off;
        EXPECT_FALSE(both.isBeyond(inside, 0));
      }
    }
  }
}

/// Also where the tangents of a patch turn far, or are nearly parallel.
TEST(NormalCones, OfAPatchContainsItsNormals) {
  Random random(2);
  int narrow = 0;
  for (int round = 0; round < 2000; ++round) {
    BezierPatch patch;
    patch.anchor.setZero();
    const double skew = random.below(2) == 0 ? 0 : 1 - std::pow(10., random.uniform(-6, 0));
    const double noise = std::pow(10., random.uniform(-8, 0));
    for (int i = 0; i < 16; ++i) {
      const double s = i % 4 / 3., t = i / 4 / 3.;
      const Vector3 bump = random.vector(noise * (1 - skew));
      patch.points[i] = {s - skew * t + bump[0], (1 - skew) * t + bump[1], bump[2], 0};
    }
    const NormalCone cone = normalCone(patch);
    narrow += cone.angle < 1;
    for (int place = 0; place < 20; ++place) {
      BezierPatch::Values at;
      patch.evaluate<1>(random.uniform(), random.uniform(), at);
      const Vector3 normal = Vector3(at.ds.head<3>()).cross(Vector3(at.dt.head<3>())).normalized();
      EXPECT_FALSE(cone.isBeyond(normal, 0)) << skew << ", " << noise;
    }
  }
  EXPECT_GT(narrow, 1000);
}

}  // namespace
}  // namespace limitsurf::test
