// SPDX-License-Identifier: Apache-2.0
//
// Gigabytes are taken from the system in steps, between which an interruption is heard.
#include "limitsurf/gradual_resize.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

constexpr std::size_t kStep = std::size_t{8} << 20;  // bytes

template <typename Call>
std::size_t passesOf(const Call& call) {
  std::size_t passes = 0;
  const InterruptionPoint point([&] { ++passes; });
  call();
  return passes;
}

TEST(GradualResize, GivesElementsTheirDefaultsInSteps) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3'000'000}}) {
    std::vector<Location> places;
    const std::size_t passes = passesOf([&] { resizeGradually(places, count); });
    EXPECT_GE(passes, count * sizeof(Location) / kStep);
    ASSERT_EQ(places.size(), count);
    EXPECT_EQ(places.capacity(), count);
    for (const Location& place : places) {
      ASSERT_TRUE(place.face == -1 && place.u == 0 && place.v == 0);
    }
  }
}

TEST(GradualResize, KeepsWhatIsThere) {
  std::vector<std::int64_t> numbers = {3, 4, 5};
  resizeGradually(numbers, 2);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{3, 4}));
  resizeGradually(numbers, 4);
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{3, 4, 0, 0}));
}

TEST(GradualResize, ScatterJitteredMakesItsResultSo) {
  const LimitSurface surface = limitSurface(fullGrid(1, 1));
  constexpr std::size_t kSide = 2048, kPlaces = kSide * kSide;
  std::vector<Location> places;
  const std::size_t passes =
      passesOf([&] { places = scatterJittered(surface, static_cast<int>(kSide), 0, 1); });
  ASSERT_EQ(places.size(), kPlaces);
  constexpr std::size_t kTasks = kPlaces / 8192;  // each passes as well
  EXPECT_GE(passes, kTasks + kPlaces * sizeof(Location) / kStep);
}

}  // namespace
}  // namespace limitsurf::test
