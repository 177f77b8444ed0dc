// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/direction_maps.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace limitsurf {
namespace {

Eigen::Matrix3d sheared() {
  Eigen::Matrix3d matrix;
  matrix << 1, 0.2, 0, 0, 1.1, 0.1, 0.1, 0, -0.7;
  return matrix;
}

TEST(OwnUnit, ExistsForAllLengths) {
  using Limits = std::numeric_limits<double>;
  for (const double length : {1., 3.5, 1e300, Limits::max(), 1e-300, Limits::min()}) {
    const double scaled = length * scaleToOwnUnit(length);
    EXPECT_GE(scaled, 1) << length;
    EXPECT_LT(scaled, 2) << length;
  }
  EXPECT_GT(Limits::denorm_min() * scaleToOwnUnit(Limits::denorm_min()), 1e-20);
  EXPECT_EQ(scaleToOwnUnit(0), 1);
  EXPECT_EQ(scaleToOwnUnit(Limits::infinity()), 1);
  EXPECT_EQ(scaleToOwnUnit(Limits::quiet_NaN()), 1);
}

TEST(DirectionMaps, AreTheSameInEveryUnit) {
  const DirectionMaps expected(sheared());
  EXPECT_EQ(expected.side, -1);
  EXPECT_EQ(expected.vectors, sheared());  // whose largest entry is between 1 and 2
  const Eigen::Matrix3d product = expected.normals.transpose() * expected.vectors;
  EXPECT_TRUE((product / product(0, 0)).isIdentity(1e-15));
  for (const int exponent : {-1070, -1000, -400, 400, 1000, 1023}) {
    const DirectionMaps found(std::ldexp(1, exponent) * sheared());
    if (exponent > -1010) {  // subnormal numbers have fewer digits
      EXPECT_EQ(found.vectors, expected.vectors);
      EXPECT_EQ(found.normals, expected.normals);
    }
    EXPECT_EQ(found.side, -1);
  }
}

TEST(DirectionMaps, KeepAxesOfDifferentSizes) {
  const Vector3 sizes(1e200, -1, 1e-100);
  const DirectionMaps found(Eigen::Matrix3d(sizes.asDiagonal()));
  EXPECT_EQ(found.side, -1);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 unit = Vector3::Unit(axis) * (sizes[axis] < 0 ? -1 : 1);
    EXPECT_EQ(safelyNormalized(found.vectors.col(axis)), unit);
    EXPECT_EQ(safelyNormalized(found.normals.col(axis)), unit);
  }
}

TEST(DirectionMaps, OfSingularMapsHaveNoNormals) {
  Eigen::Matrix3d flat = sheared();
  flat.col(1).setZero();
  EXPECT_FALSE(DirectionMaps(flat).normals.allFinite());
  EXPECT_TRUE(DirectionMaps(flat).vectors.allFinite());
}

}  // namespace
}  // namespace limitsurf
