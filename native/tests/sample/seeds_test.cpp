// SPDX-License-Identifier: Apache-2.0
//
// Random locations of different seeds have nothing in common, not even of seeds that are small
// numbers like those of the samples.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

constexpr int kSeeds = 8;

/// Counts the places that some seed and an earlier one have in common. `placesOf(seed)` is a list
/// of them.
template <typename PlacesOf>
int commonPlaces(const PlacesOf& placesOf) {
  std::set<std::array<double, 3>> all;
  int common = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    for (const Location& at : placesOf(static_cast<std::uint64_t>(seed))) {
      common += !all.insert({double(at.face), at.u, at.v}).second;
    }
  }
  return common;
}

TEST(Seeds, UniformLocationsHaveNoneInCommon) {
  const LimitSurface surface = limitSurface(mixture(3));
  const AreaSampler sampler(surface);
  EXPECT_EQ(commonPlaces([&](std::uint64_t seed) { return sampler.uniform(2000, seed); }), 0);
}

TEST(Seeds, BlueNoiseHasNoneInCommon) {
  const LimitSurface surface = limitSurface(mixture(3));
  const AreaSampler sampler(surface);
  EXPECT_EQ(commonPlaces([&](std::uint64_t seed) {
              BlueNoiseOptions options;
              options.count = 2000;
              options.seed = seed;
              return sampler.blueNoise(options).at;
            }),
            0);
}

TEST(Seeds, JitteredLocationsHaveNoOffsetsInCommon) {
  const LimitSurface surface = limitSurface(mixture(3));
  constexpr int kSide = 16;  // a power of two: offsets are exact
  EXPECT_EQ(commonPlaces([&](std::uint64_t seed) {
              std::vector<Location> offsets = scatterJittered(surface, kSide, seed);
              for (Location& at : offsets) {
                at = {0, at.u * kSide - std::floor(at.u * kSide),
                      at.v * kSide - std::floor(at.v * kSide)};
              }
              return offsets;
            }),
            0);
}

}  // namespace
}  // namespace limitsurf::test
