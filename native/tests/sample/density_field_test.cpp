// SPDX-License-Identifier: Apache-2.0
//
// Densities between the points of a grid, against sums of many of their values.
#include "limitsurf/sample/density_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limitsurf::test {
namespace {

/// A function that its values at the points of a grid do not tell at other places.
Density waves() {
  return Density([](Span<Location> at, double* weights) {
    for (const Location& location : at) {
      *weights++ = 2 + std::sin(40 * location.u + 3 * location.face) * std::cos(31 * location.v);
    }
  });
}

/// The mean of the field's values at the middles of n x n squares.
double meanOfMany(const DensityField& field, const FaceRectangle& on, int n) {
  double sum = 0;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      sum += field.at(on.at((x + 0.5) / n, (y + 0.5) / n));
    }
  }
  return sum / n / n;
}

TEST(DensityField, MeansTakeAllPointsOfTheGrid) {
  const DensityField field(waves(), {3, 5});
  FaceRectangle whole;
  whole.face = 1;
  FaceRectangle turned{0, 1, 0, -1, 0, 1, 0};
  for (const FaceRectangle& face : {whole, turned}) {
    for (const FaceRectangle& on : {face, face.part(0.1, 0.3, 0.55, 0.7), face.part(0, 0, 0.5, 1),
                                    face.part(0.26, 0.26, 0.001, 0.3)}) {
      // The middles of squares that lie within one square of the grid tell its mean exactly, and
      // the others are few.
      EXPECT_NEAR(field.meanOn(on), meanOfMany(field, on, 1024), 1e-6) << on.face << " " << on.u0;
    }
  }
}

TEST(DensityField, MeansOfTinyRectanglesAreItsValues) {
  const DensityField field(waves(), {4});
  const FaceRectangle tiny{0, 1, -0x1p-60, 0, 0.5, 0, 0x1p-70};
  EXPECT_DOUBLE_EQ(field.meanOn(tiny), field.at({0, 1, 0.5}));
}

}  // namespace
}  // namespace limitsurf::test
