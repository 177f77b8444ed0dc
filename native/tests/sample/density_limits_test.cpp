// SPDX-License-Identifier: Apache-2.0
//
// Uniform scattering by a density function with limits: the same distribution, by far fewer
// candidates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "limitsurf/sample/area_sampler.h"
#include "support/cages/meshes.h"
#include "support/throws.h"
#include "support/truth/scatter_witness.h"

namespace limitsurf::test {
namespace {

/// A correct sampler exceeds this once in a few million tests.
constexpr double kMostDeviations = 5;
constexpr int kSide = 4, kPoints = 24;

/// The weights of a function, which counts how many it was asked for.
Density counted(const Weight& weight, std::size_t& asked, DensityLimits limits = {}) {
  return Density(
      [weight, &asked](Span<Location> at, double* weights) {
        asked += at.size();
        for (const Location& l : at) *weights++ = weight(l);
      },
      std::move(limits));
}

/// Limits from the values of a function at the corners of squares, where it has its extremes there.
DensityLimits limitsOf(const LimitSurface& surface, int side, const Weight& weight) {
  std::vector<double> values;
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        double most = 0;
        for (int corner = 0; corner < 4; ++corner) {
          most = std::max(most, weight({face, double(column + (corner & 1)) / side,
                                        double(row + (corner >> 1)) / side}));
        }
        values.push_back(most);
      }
    }
  }
  return DensityLimits(side, std::move(values));
}

TEST(DensityLimits, KeepTheDistribution) {
  const LimitSurface surface = limitSurface(scatteredCage());
  const Weight weight = [](const Location& l) {
    return l.face % 3 == 0 ? 0 : l.u * l.u + 0.1 * (l.face % 5) * (1 - l.v);
  };
  const std::vector<double> expected = areas(surface, kSide, kPoints, weight);
  const AreaSampler sampler(surface);
  for (const int side : {1, 4, 16}) {
    std::size_t asked = 0;
    const Density density = counted(weight, asked, limitsOf(surface, side, weight));
    const std::vector<Location> at = sampler.uniform(400000, 3, density);
    ASSERT_EQ(at.size(), 400000u);
    EXPECT_LT(std::abs(chiSquareDeviation(counts(surface, at, kSide), expected)), kMostDeviations)
        << "side " << side;
  }
}

/// A spot on a part of the surface: without limits nearly all candidates lie elsewhere.
TEST(DensityLimits, SaveCandidates) {
  const LimitSurface surface = limitSurface(bent(grid(20, 20)));
  const Weight spot = [](const Location& l) {
    return l.face == 77 && std::hypot(l.u - 0.4, l.v - 0.6) < 0.1 ? 1. : 0.;
  };
  const AreaSampler sampler(surface);
  const auto askedFor = [&](int side) {
    std::size_t asked = 0;
    const Density density = counted(spot, asked,
                                    side ? limitsOf(surface, side,
                                                    [](const Location& l) {
                                                      const bool near = l.u > 0.2 && l.u < 0.6 &&
                                                                        l.v > 0.4 && l.v < 0.8;
                                                      return l.face == 77 && near ? 1. : 0.;
                                                    })
                                         : DensityLimits());
    const std::vector<Location> at = sampler.uniform(200, 5, density);
    EXPECT_EQ(at.size(), 200u);
    for (const Location& l : at) EXPECT_EQ(spot(l), 1);
    return asked;
  };
  EXPECT_GT(askedFor(0), 1000000u);
  EXPECT_LT(askedFor(16), 12000u);
}

TEST(DensityLimits, DoNotDependOnThreadsOrCount) {
  const LimitSurface surface = limitSurface(scatteredCage());
  const Weight weight = [](const Location& l) { return l.u * (l.face % 4); };
  std::size_t asked = 0;
  const Density density = counted(weight, asked, limitsOf(surface, 2, weight));
  const AreaSampler sampler(surface);
  const auto same = [](const Location& a, const Location& b) {
    return a.face == b.face && a.u == b.u && a.v == b.v;
  };
  const std::vector<Location> all = sampler.uniform(50000, 7, density);
  const std::vector<Location> one = sampler.uniform(50000, 7, density, 1);
  const std::vector<Location> few = sampler.uniform(100, 7, density);
  EXPECT_TRUE(std::equal(all.begin(), all.end(), one.begin(), same));
  EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin(), same));
}

/// Blue noise does not ask where the limit is 0, and all else stays the same.
TEST(DensityLimits, DoNotChangeBlueNoise) {
  const LimitSurface surface = limitSurface(scatteredCage());
  const Weight weight = [](const Location& l) {
    return l.face % 5 == 0 && l.u > 0.5 && l.v < 0.25 ? l.u * l.u : 0.;
  };
  const AreaSampler sampler(surface);
  std::size_t asked = 0, asked_less = 0;
  BlueNoiseOptions options;
  options.count = 700;
  options.density = counted(weight, asked);
  const BlueNoise all = sampler.blueNoise(options);
  options.density = counted(weight, asked_less, limitsOf(surface, 8, weight));
  const BlueNoise same = sampler.blueNoise(options);
  EXPECT_EQ(all.radius, same.radius);
  ASSERT_EQ(same.at.size(), 700u);
  for (std::size_t i = 0; i < all.at.size(); ++i) {
    EXPECT_TRUE(all.at[i].face == same.at[i].face && all.at[i].u == same.at[i].u &&
                all.at[i].v == same.at[i].v);
  }
  EXPECT_LT(asked_less, asked / 10);
  options.density = counted(weight, asked, DensityLimits(1, {1, 1}));
  expectThrow<std::invalid_argument>([&] { sampler.blueNoise(options); }, {"for 2 faces"});
}

TEST(DensityLimits, AreChecked) {
  Cage cage = grid(3, 1);
  cage.options.holes = {1};
  const LimitSurface surface = limitSurface(cage);
  const AreaSampler sampler(surface);
  std::size_t asked = 0;
  const auto fails = [&](int side, std::vector<double> values,
                         const std::vector<std::string>& parts) {
    expectThrow<std::invalid_argument>(
        [&] {
          sampler.uniform(5, 1,
                          counted([](const Location&) { return 0.5; }, asked,
                                  DensityLimits(side, std::move(values))));
        },
        parts);
  };
  fails(3, std::vector<double>(27), {"3 squares", "power of two"});
  fails(0, {}, {"0 squares", "power of two"});
  fails(2, {1, 2, 3}, {"3 density limits", "4 for each face"});
  fails(1, {1, 1}, {"for 2 faces", "has 3"});
  fails(1, {1, 1, -1}, {"face 2, row 0, column 0", "-1"});
  fails(2, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, NAN, 1}, {"face 2, row 1, column 0", "nan"});
  fails(1, {0, 1, 0}, {"0 everywhere"});
  fails(1, {1, 1, 0.25}, {"density is 0.5 at face 2", "limit there is 0.25"});
  // The face without a surface needs no limit.
  const Density density =
      counted([](const Location&) { return 0.5; }, asked, DensityLimits(1, {1, NAN, 0.5}));
  EXPECT_EQ(sampler.uniform(100, 1, density).size(), 100u);
  // A huge one there does not count either: it would make all others nearly 0.
  const Density beside =
      counted([](const Location&) { return 0.5; }, asked, DensityLimits(1, {1, 1e60, 0.5}));
  EXPECT_EQ(sampler.uniform(100, 1, beside).size(), 100u);
}

}  // namespace
}  // namespace limitsurf::test
