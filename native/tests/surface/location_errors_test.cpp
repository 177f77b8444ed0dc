// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/cages/meshes.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Every batch call refuses the location `bad` in row `row` of many, and names both.
void expectRefused(const LimitSurface& surface, const Location& bad, int row,
                   const std::vector<std::string>& parts) {
  std::vector<Location> at(5000, Location{1, 0.25, 0.75});
  at[row] = bad;
  at[4999] = {99, 7, 7};  // a later invalid row, which must not be named
  std::vector<std::string> all = parts;
  all.push_back("row " + std::to_string(row));
  expectThrow<LocationError>([&] { surface.evaluate(at); }, all);
  expectThrow<LocationError>([&] { surface.evaluate(at, Derivatives::second, true, 2); }, all);
  expectThrow<LocationError>([&] { surface.frames(at); }, all);
  expectThrow<LocationError>([&] { surface.curvature(at); }, all);
  expectThrow<LocationError>([&] { surface.stencils(at, true); }, all);
}

TEST(LocationErrors, FacesAreInRange) {
  const LimitSurface surface = limitSurface(cross());
  for (int face :
       {-1, 5, 1000000, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    expectRefused(surface, {face, 0.5, 0.5}, 17, {std::to_string(face)});
  }
}

TEST(LocationErrors, UvIsInTheUnitSquare) {
  const LimitSurface surface = limitSurface(cross());
  for (double bad :
       {kNan, -1e-17, -5e-324, 1 + 0x1p-52, 2.0, std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    expectRefused(surface, {2, bad, 0.5}, 0, {});
    expectRefused(surface, {2, 0.5, bad}, 3210, {});
  }
  expectRefused(surface, {2, -1e-17, 0.5}, 42, {"-1"});
  expectRefused(surface, {2, 0.5, kNan}, 42, {"nan"});
}

TEST(LocationErrors, TheWholeUnitSquareIsFine) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{0, 0, 0}, {4, 1, 1}, {0, -0.0, 1}, {3, 5e-324, 1 - 0x1p-53}};
  EXPECT_TRUE(surface.evaluate(at).position.allFinite());
}

TEST(LocationErrors, NegativeThreadsAreNot) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  EXPECT_THROW(surface.evaluate(at, Derivatives::none, false, -1), std::invalid_argument);
  EXPECT_NO_THROW(surface.evaluate(at, Derivatives::none, false, 1000));
}

}  // namespace
}  // namespace limitsurf::test
