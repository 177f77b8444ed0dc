// SPDX-License-Identifier: Apache-2.0
//
// Searches of UV maps for single points.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "limitsurf/uv/uv_map.h"
#include "support/cages/query_cages.h"
#include "support/throws.h"
#include "support/truth/uv_witness.h"

namespace limitsurf::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(UvLocate, FindsThePlacesThatPointsCameFrom) {
  double worst = 0;
  std::size_t same = 0, all = 0;
  Random random(3);
  for (const NamedMap& named : uvMaps()) {
    SCOPED_TRACE(named.name);
    const std::vector<Location> at = searchedLocations(named.surface, 300, random);
    const PlanePoints points = named.map.evaluate(at).value;
    const MapLocations found = UvMap(named.map).locate(points);
    std::vector<Location> again;
    for (std::size_t i = 0; i < at.size(); ++i) {
      ASSERT_GE(found.at[i].face, 0) << describe(at[i]);
      ASSERT_LE(found.at[i].face, at[i].face) << describe(at[i]);
      again.push_back(found.at[i]);
      ++all;
      same += found.at[i].face == at[i].face && std::abs(found.at[i].u - at[i].u) < 1e-6 &&
              std::abs(found.at[i].v - at[i].v) < 1e-6;
    }
    const double error = (named.map.evaluate(again).value - points).rowwise().norm().maxCoeff();
    worst = std::max(worst, error);
    EXPECT_LE(error, kMapError);
  }
  std::printf("worst error %.2g; %zu of %zu the same places\n", worst, same, all);
}

TEST(SlowUvLocate, AgreesWithDenseTriangles) {
  Random random(8);
  DataRows points(400, 2);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points.row(row) << random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1);
  }
  for (const NamedMap& named : uvMaps()) {
    SCOPED_TRACE(named.name);
    const UvWitness witness(named.surface, named.map, 16);
    const std::vector<UvWitness::Answer> truth = witness.at(points);
    const MapLocations found = UvMap(named.map).locate(PlanePoints(points));
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (!truth[i].known) continue;
      ASSERT_EQ(found.at[i].face, truth[i].sheets.lowest_face) << i;
      ASSERT_EQ(found.overlap[i] != 0, truth[i].sheets.count > 1) << i;
      if (truth[i].sheets.of_lowest_face == 1) {
        ASSERT_EQ(found.flipped[i] != 0, truth[i].sheets.flipped) << i;
      }
    }
  }
}

TEST(UvLocate, IsTheSameForAnyBatchAndNumberOfThreads) {
  Random random(4);
  PlanePoints points(700, 2);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points.row(row) << random.uniform(), random.uniform();
  }
  for (const NamedMap& named : uvMaps()) {
    const UvMap map(named.map);
    const MapLocations one = map.locate(points, 1), two = map.locate(points, 2);
    const MapLocations tail = map.locate(points.bottomRows(7), 1);
    for (std::size_t i = 0; i < one.at.size(); ++i) {
      const auto same = [&](const Location& a, const Location& b) {
        return a.face == b.face && a.u == b.u && a.v == b.v;
      };
      ASSERT_TRUE(same(one.at[i], two.at[i]));
      if (i >= one.at.size() - 7) {
        ASSERT_TRUE(same(one.at[i], tail.at[i - (one.at.size() - 7)]));
      }
    }
    EXPECT_EQ(one.overlap, two.overlap);
    EXPECT_EQ(one.flipped, two.flipped);
  }
}

TEST(UvLocate, PointsThatAreNoneAreRefused) {
  const NamedMap named = std::move(uvMaps().front());
  const UvMap map(named.map);
  EXPECT_TRUE(map.locate(PlanePoints(0, 2)).at.empty());
  PlanePoints points = PlanePoints::Zero(3, 2);
  points(2, 1) = std::numeric_limits<double>::quiet_NaN();
  expectThrow<std::invalid_argument>([&] { map.locate(points); }, {"row 2", "nan", "not finite"});
  points(2, 1) = kInfinity;
  expectThrow<std::invalid_argument>([&] { map.locate(points); }, {"row 2", "inf", "not finite"});
  points(2, 1) = 1e200;
  expectThrow<std::invalid_argument>([&] { map.locate(points); },
                                     {"row 2", "too far", "at most 1e+150"});
  points(2, 1) = 1e140;
  EXPECT_EQ(map.locate(points).at[2].face, -1);
}

}  // namespace
}  // namespace limitsurf::test
