// SPDX-License-Identifier: Apache-2.0
//
// Short ways along the surface: against closed forms, and against the distances of guides.
#include "limitsurf/geodesic/shortest_ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/geodesic/guide_weights.h"
#include "support/cages/cage_builder.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"

namespace limitsurf::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// By how much a way may be longer than a distance of guides says, of which kGuideDistanceError is
/// the distance's own: the triangles of ways are larger. At poles they are far from the surface.
constexpr double kLonger = 0.03, kLongerAtPoles = 2;

/// The length of a way on the surface, by chords. Fails where its parts do not follow each other.
double lengthOf(const LimitSurface& surface, const std::vector<WayPart>& parts) {
  constexpr int kChords = 8;
  double length = 0;
  Vector3 last = Vector3::Zero();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Location &from = parts[i].from, &to = parts[i].to;
    EXPECT_EQ(from.face, to.face);
    std::vector<Location> at;
    for (int k = 0; k <= kChords; ++k) {
      const double t = double(k) / kChords;
      at.push_back({from.face, from.u + t * (to.u - from.u), from.v + t * (to.v - from.v)});
    }
    const Points on = surface.evaluate(at).position;
    if (i > 0) {
      EXPECT_LE((Vector3(on.row(0)) - last).norm(), 1e-9 * surface.positions().norm());
    }
    length += (on.bottomRows(kChords) - on.topRows(kChords)).rowwise().norm().sum();
    last = on.row(kChords);
  }
  return length;
}

TEST(ShortestWays, AreStraightOnAFlatSheet) {
  Cage cage = perturbed(fullGrid(6, 5), 0.2, 5);
  cage.positions.col(2).setZero();
  const LimitSurface surface = limitSurface(cage);
  const ShortestWays ways(surface, 0);
  Random random(3);
  const std::vector<Location> at = searchedLocations(surface, 100, random);
  const Points on = surface.evaluate(at).position;
  for (int i = 0; i < 50; ++i) {
    const double distance = (on.row(2 * i) - on.row(2 * i + 1)).norm();
    const std::vector<WayPart> parts = ways.find(at[2 * i], at[2 * i + 1], kInfinity);
    ASSERT_FALSE(parts.empty());
    EXPECT_LE(lengthOf(surface, parts), distance * (1 + 1e-4) + 1e-9);
    EXPECT_TRUE(distance < 0.1 || ways.find(at[2 * i], at[2 * i + 1], 0.9 * distance).empty());
  }
}

/// Returns the number of ways.
int compareWithGuides(const NamedCages& cages) {
  Random random(8);
  int compared = 0;
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const ShortestWays ways(surface, 0);
    const std::vector<Location> at = searchedLocations(surface, 5, random);
    const double size = diagonal(surface.positions());
    const double longer = name == "valence 100" ? kLongerAtPoles : kLonger;
    const GuideWeights found = guideWeights(surface, std::vector<Location>{at[0]}, at, {1});
    for (std::size_t i = 1; i < at.size(); ++i) {
      const std::vector<WayPart> parts = ways.find(at[i], at[0], kInfinity);
      if (!std::isfinite(found.distance[i])) {
        EXPECT_TRUE(parts.empty()) << name;
        continue;
      }
      EXPECT_FALSE(parts.empty()) << name << ", " << i;
      const double length = lengthOf(surface, parts);
      EXPECT_LE(length, (1 + longer) * found.distance[i] + 1e-3 * size) << name << ", " << i;
      EXPECT_GE(length, (1 - kLonger) * found.distance[i] - 1e-3 * size) << name << ", " << i;
      ++compared;
    }
  }
  return compared;
}

TEST(ShortestWays, AreAsLongAsTheDistancesOfGuides) {
  EXPECT_GT(compareWithGuides(everyNth(queryCages(), 12)), 6);
}

TEST(SlowShortestWays, AreAsLongAsTheDistancesOfGuides) {
  EXPECT_GT(compareWithGuides(queryCages()), 60);
}

TEST(ShortestWays, DoNotLeadFromOnePartToAnother) {
  CageBuilder builder;
  builder.append(fullGrid(2, 2));
  builder.append(placed(fullGrid(2, 2), 1, {0, 0, 0.01}));
  const LimitSurface surface = limitSurface(builder.build());
  const ShortestWays ways(surface, 0);
  EXPECT_TRUE(ways.find({0, 0.5, 0.5}, {4, 0.5, 0.5}, kInfinity).empty());
  EXPECT_EQ(ways.find({0, 0.5, 0.5}, {0, 0.5, 0.5}, kInfinity).size(), 1u);
}

}  // namespace
}  // namespace limitsurf::test
