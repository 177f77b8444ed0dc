// SPDX-License-Identifier: Apache-2.0
//
// The cost of a search on one patch that is squeezed to nearly a line, or to a point.
#include "limitsurf/search/closest_on_patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Cells of the search of one patch: twice what the searches below need.
constexpr int kMostCells = 1000;

/// A patch in the plane z = 0 whose lines of constant y are curved: narrow along x.
BezierPatch narrowPatch(double squeeze, Random& random) {
  BezierPatch patch;
  patch.anchor.setZero();
  patch.borders = kSideS0 | kSideS1 | kSideT0 | kSideT1;  // its closest point may be no foot
  for (int i = 0; i < 16; ++i) {
    const Vector3 bump = random.vector(0.05);
    const int row = i / 4, column = i % 4;
    patch.points[i] = {squeeze * (column / 3. + bump[0]), row / 3. + bump[1], 0, 0};
  }
  return patch;
}

TEST(ClosestOnPatch, TakesABoundedTimeOnNarrowPatches) {
  Random random(1);
  for (const double squeeze : {1e-8, 1e-10, 1e-11, 1e-12, 1e-13, 1e-15}) {
    for (int round = 0; round < 100; ++round) {
      const BezierPatch patch = narrowPatch(squeeze, random);
      BezierPatch::Values place;
      patch.evaluate<0>(random.uniform(), random.uniform(), place);
      const double aside = round % 4 * squeeze;
      const Vector3 point = place.value.head<3>().matrix() + Vector3(aside, 0, 0);
      ClosestSoFar best;
      best.from = SearchPoint(point, Vector3::Zero(), 1);
      best.tolerance = 1e-13;
      closestOnPatch(patch, FootBound(patch), nullptr, best);
      EXPECT_LE(best.excess, aside + 1.01 * best.tolerance) << squeeze;
      EXPECT_LE(best.cells, kMostCells) << squeeze << ", aside " << aside;
    }
  }
}

/// A patch that is nearly a straight line in some direction of space, along which it may run back
/// and forth.
BezierPatch lineLikePatch(double squeeze, bool folded, Random& random) {
  const Eigen::Matrix3d turn = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                                  random.uniform(-1, 1), random.uniform(-1, 1))
                                   .normalized()
                                   .toRotationMatrix();
  BezierPatch patch;
  patch.anchor.setZero();
  patch.borders = kSideS0 | kSideS1 | kSideT0 | kSideT1;
  for (int i = 0; i < 16; ++i) {
    const int row = i / 4, column = i % 4;
    const Vector3 bump = random.vector(1);
    const double along = folded ? random.uniform() : (row + column) / 3. + 0.05 * bump[0];
    const Vector3 point = turn * Vector3(along, squeeze * bump[1], squeeze * bump[2]);
    patch.points[i] = {point[0], point[1], point[2], 0};
  }
  return patch;
}

/// Where the line is not along an axis, what is across it was lost in rounding, and many places are
/// almost equally close: such searches looked at 2^17 cells, their limit, and found places that
/// were farther away than others by ten tolerances.
TEST(ClosestOnPatch, TakesABoundedTimeOnLinesInSpace) {
  Random random(3);
  for (const double squeeze : {1e-6, 1e-8, 1e-10, 1e-11, 3e-12, 1e-12, 5e-13, 1e-13, 1e-14}) {
    for (int round = 0; round < 100; ++round) {
      const BezierPatch patch = lineLikePatch(squeeze, round % 2 == 0, random);
      BezierPatch::Values place;
      patch.evaluate<0>(random.uniform(), random.uniform(), place);
      const Vector3 known = place.value.head<3>().matrix();
      const double aside =
          round % 5 == 4 ? std::pow(10., random.uniform(-12, 0)) : round % 4 * squeeze;
      const Vector3 point = known + aside * random.vector(1);
      ClosestSoFar best;
      best.from = SearchPoint(point, Vector3::Zero(), 1);
      best.tolerance = 1e-13;
      closestOnPatch(patch, FootBound(patch), nullptr, best);
      EXPECT_LE(best.excess, (point - known).norm() + 1.01 * best.tolerance) << squeeze;
      EXPECT_LE(best.cells, kMostCells) << squeeze << ", aside " << aside;
    }
  }
}

/// As on a mesh whose vertices are all in one place, such as an object that is scaled to 0. All
/// parts of the patch are equally close but for rounding, and without extent the tolerance is 0.
TEST(ClosestOnPatch, LooksOnceAtAPatchInOnePlace) {
  Random random(2);
  BezierPatch patch;
  patch.anchor = {0.1, -7, 1000, 0};
  patch.borders = 0;
  for (BezierPatch::Point& point : patch.points) {
    point.setZero();
  }
  const Vector3 place = patch.anchor.head<3>().matrix();
  for (int round = 0; round < 100; ++round) {
    const Vector3 point = place + random.vector(1);
    ClosestSoFar best;
    best.from = SearchPoint(point, place, 0);
    closestOnPatch(patch, FootBound(patch), nullptr, best);
    EXPECT_NEAR(best.excess, (point - place).norm(), 1e-13);
    EXPECT_LE(best.cells, 1);
  }
}

}  // namespace
}  // namespace limitsurf::test
