// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/eigen/ring_shrinkage.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace limitsurf::test {
namespace {

TEST(RingShrinkage, BoundsTheDistancesFromTheLimit) {
  const int steps = 60;
  Random random(5);
  for (const RingKind kind : {RingKind::interior, RingKind::boundary, RingKind::pinned,
                              RingKind::cone, RingKind::dart, RingKind::tip, RingKind::loop}) {
    for (const int faces : {2, 3, 5, 8, 16}) {
      const Ring ring = {kind, faces};
      const auto basis = Eigenbasis::get(ring);
      const std::vector<double> bounds = ringShrinkage(*basis, steps);
      ASSERT_EQ(bounds.size(), steps + 1u);
      Points points(ring.size(), 3), coefficients;
      for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = random.uniform(-1, 1);
      basis->project(points, coefficients);
      const Vector3 limit = coefficients.row(0);
      points.rowwise() -= limit.transpose();
      const double before = points.rowwise().norm().maxCoeff();
      for (int step = 0; step <= steps; ++step) {
        const double distance = points.rowwise().norm().maxCoeff();
        EXPECT_LE(distance, bounds[step] * before + 1e-14) << faces << " faces, step " << step;
        points = subdivideRing(ring, points);
      }
      // No eigenvalue but 1 is above 0.6546.
      EXPECT_LE(bounds[steps], 2 * steps * std::pow(0.6546, steps)) << faces << " faces";
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
