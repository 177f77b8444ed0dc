// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/oriented_box.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/random.h"

namespace limitsurf::test {
namespace {

template <typename Real>
void containsItsPoints() {
  Random random(1);
  double thickest = 0;
  for (int round = 0; round < 20000; ++round) {
    const Vector3 along = random.vector(1), across = random.vector(1), corner = random.vector(1);
    const double height = std::pow(10., random.uniform(-17, -1));
    const Vector3 normal = along.cross(across);
    std::vector<Padded> points(16);
    for (int i = 0; i < 16; ++i) {
      points[static_cast<std::size_t>(i)] << (corner + i % 4 * 0.1 * along + i / 4 * 0.1 * across +
                                              random.uniform(-height, height) * normal)
                                                 .array(),
          0;
    }
    const OrientedBox<Real> box(points, along, across);
    for (const Padded& point : points) {
      ASSERT_EQ(box.squaredDistance(point.head<3>()), 0);
    }
    const Vector3 above = points[5].head<3>().matrix() + 2 * normal;
    thickest = std::max(thickest, 2 * normal.norm() - 3 * height * normal.norm() -
                                      std::sqrt(box.squaredDistance(above)));
    // Its corners are those of a box around the points.
    Padded low = box.corner(0), high = low;
    for (int i = 1; i < 8; ++i) {
      low = low.min(box.corner(i));
      high = high.max(box.corner(i));
    }
    for (const Padded& point : points) {
      EXPECT_TRUE((point >= low - 1e-7).all() && (point <= high + 1e-7).all());
    }
  }
  EXPECT_LE(thickest, 1e-5);  // it is no thicker than the points are high
}

/// The rounding of its numbers is included.
TEST(OrientedBox, ContainsItsPoints) {
  containsItsPoints<float>();
  containsItsPoints<double>();
}

}  // namespace
}  // namespace limitsurf::test
