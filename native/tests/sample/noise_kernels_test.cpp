// SPDX-License-Identifier: Apache-2.0
//
// Trials of blue noise, many at once, against the same one by one; discs found, by brute force.
#include "limitsurf/sample/blue_noise/noise_kernels.h"

#include <gtest/gtest.h>

#include <set>

#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/blue_noise/disc_finder.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Calls check() with each available instruction set in use.
template <typename Check>
void withEachSet(const Check& check) {
  const InstructionSet before = instructionSet();
  for (const InstructionSet set :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (isAvailable(set)) {
      useInstructionSet(set);
      check();
    }
  }
  useInstructionSet(before);
}

Vector3 randomVector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Box boxOfRandomVectors() {
  Box box;
  box.include(Vector3(-1, -1, -1));
  box.include(Vector3(1, 1, 1));
  return box;
}

std::vector<NoiseDisc> randomDiscs(Random& random, int count, double least, double most) {
  std::vector<NoiseDisc> discs(static_cast<std::size_t>(count));
  for (NoiseDisc& disc : discs) {
    disc.position = randomVector(random);
    disc.normal = randomVector(random).normalized();
    disc.radius = random.uniform(least, most);
    disc.rank = static_cast<int>(4 * random.uniform());  // many are equal
  }
  return discs;
}

bool isCloserThanMeanOfRadii(const NoiseDisc& a, const NoiseDisc& b) {
  return (a.position - b.position).norm() < (a.radius + b.radius) / 2;
}

TEST(NoiseKernels, FindPlacesAndExtentsAsPatchesDo) {
  Random random(1);
  BezierPatch patch;
  patch.anchor = {1, 2, 3, 0};
  for (BezierPatch::Point& point : patch.points) {
    const Vector3 p = randomVector(random);
    point = {p[0], p[1], p[2], 0};
  }
  PlaceBlock places;
  ExtentBlock extents;
  for (int i = 0; i < PlaceBlock::kCount; ++i) {
    extents.s[i] = places.s[i] = random.uniform();
    extents.t[i] = places.t[i] = random.uniform();
    extents.half_width[i] = extents.half_height[i] = 0.25;
  }
  withEachSet([&] {
    NoiseKernels::get().places(patch, places);
    NoiseKernels::get().extents(patch, DerivativeBounds(), extents);
    for (int i = 0; i < PlaceBlock::kCount; ++i) {
      BezierPatch::Values values;
      patch.evaluate<1>(places.s[i], places.t[i], values);
      const Vector3 normal = limitsurf::cross(values.ds, values.dt);
      EXPECT_EQ(places.area[i], length(normal));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(places.position[axis][i], values.value[axis] + patch.anchor[axis]);
        EXPECT_EQ(places.normal[axis][i], normal[axis] / length(normal));
        EXPECT_EQ(extents.middle[axis][i], places.position[axis][i]);
        EXPECT_EQ(extents.normal[axis][i], normal[axis]);
        EXPECT_EQ(extents.half_s[axis][i], 0.25 * values.ds[axis]);
        EXPECT_EQ(extents.half_t[axis][i], 0.25 * values.dt[axis]);
      }
    }
  });
}

TEST(NoiseKernels, FindConflictsAndCoveredParts) {
  Random random(2);
  int conflicts = 0, covered_parts = 0;
  for (int round = 0; round < 300; ++round) {
    const std::vector<NoiseDisc> discs = randomDiscs(random, round % 21, 0.2, 1);
    NearDiscs near;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      near.add(discs[i], static_cast<std::int32_t>(i));
    }
    const NoiseDisc own = randomDiscs(random, 1, 0.2, 1).front();
    const double number = 10;
    bool conflict = false;
    CellParts parts;
    parts.smallest = 0.8;
    const Vector3 normal = randomVector(random);
    for (int axis = 0; axis < 3; ++axis) parts.normal[axis] = normal[axis];
    parts.normal_reach = 0.1;
    parts.least = 0.01;
    for (int part = 0; part < CellParts::kMost; ++part) {
      parts.add(0.5 * randomVector(random), random.uniform(0, 0.4));
    }
    unsigned covered = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const NoiseDisc& disc = discs[i];
      const bool is_before =
          disc.rank < own.rank || (disc.rank == own.rank && static_cast<double>(i) < number);
      conflict |= isCloserThanMeanOfRadii(disc, own) && is_before &&
                  disc.normal.dot(own.normal) > kRightAngle;
      for (int part = 0; part < parts.count; ++part) {
        const Vector3 middle(parts.middle[0][part], parts.middle[1][part], parts.middle[2][part]);
        const double distance = (disc.position - middle).norm() + parts.reach[part];
        covered |= static_cast<unsigned>(distance < (disc.radius + parts.smallest) / 2 &&
                                         disc.normal.dot(normal) - 0.1 > 0.01)
                   << part;
      }
    }
    withEachSet([&] {
      EXPECT_EQ(near.conflict(own, number), conflict);
      EXPECT_EQ(near.covered(parts), covered);
    });
    conflicts += conflict;
    covered_parts += covered != 0;
  }
  EXPECT_GT(conflicts, 50);
  EXPECT_LT(conflicts, 250);
  EXPECT_GT(covered_parts, 20);
}

/// A disc of any radius stays before itself, and the one accepted before all others.
TEST(NoiseKernels, DiscsBeyondMeasureAreInConflict) {
  NoiseDisc accepted;
  accepted.position = accepted.normal = Vector3::UnitZ();
  accepted.radius = 1e300;
  accepted.rank = NoiseDisc::kAccepted;
  NoiseDisc own = accepted;
  own.rank = 0;
  NearDiscs near;
  EXPECT_FALSE(near.conflict(own, 0));
  near.add(accepted, 5);
  withEachSet([&] { EXPECT_TRUE(near.conflict(own, 0)); });
}

/// Both on one level of radii and on many, with any number of threads, in several steps.
TEST(DiscGrid, FindsAllDiscsThatAreInConflict) {
  Random random(3);
  const Box box = boxOfRandomVectors();
  for (const double most : {0.1, 0.9}) {
    std::vector<NoiseDisc> all;
    DiscGrid grid(box, 0.1, most);
    for (int step = 0; step < 3; ++step) {
      std::vector<std::vector<NoiseDisc>> lists;
      std::vector<Span<NoiseDisc>> spans;
      for (int list = 0; list < 5; ++list) {
        lists.push_back(randomDiscs(random, 100 * list, 0.1, most));
        all.insert(all.end(), lists.back().begin(), lists.back().end());
      }
      spans.assign(lists.begin(), lists.end());
      grid.insert(spans, step);
    }
    ASSERT_EQ(grid.size(), all.size());
    DiscFinder finder(grid);
    for (const NoiseDisc& own : randomDiscs(random, 300, 0.1, most)) {
      std::set<int> found, truth;
      grid.any(own.position, own.radius, [&](int number) {
        found.insert(number);
        return false;
      });
      const NearDiscs& near = finder.near(own.position, own.radius);
      std::size_t close = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        close += isCloserThanMeanOfRadii(near[i], own);
      }
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (isCloserThanMeanOfRadii(all[i], own)) truth.insert(static_cast<int>(i));
      }
      EXPECT_EQ(found, truth);
      EXPECT_EQ(close, truth.size());
    }
  }
}

/// Where many discs are in one place, and in others around it where few are; with equal ranks too.
TEST(DiscGrid, FindsRivalsWhereDiscsAreCrowded) {
  Random random(4);
  const Box box = boxOfRandomVectors();
  for (const double most : {0.05, 0.7}) {
    for (const double crowd : {1., 0.02, 0.}) {
      std::vector<NoiseDisc> discs = randomDiscs(random, 5000, 0.05, most);
      for (std::size_t i = 0; i < discs.size(); i += 2) {
        discs[i].position = discs[i % 3].position + crowd * discs[i].position;
        discs[i].position = discs[i].position.cwiseMax(-1).cwiseMin(1);
      }
      for (NoiseDisc& disc : discs) disc.rank = std::floor(300 * random.uniform());
      DiscGrid grid(box, 0.05, most);
      grid.insert({discs}, 2);
      grid.sortCrowded(2);
      EXPECT_EQ(grid.isCrowded(), most > 0.1 || crowd < 1);
      DiscFinder finder(grid);
      int rivals = 0;
      for (std::size_t i = 0; i < discs.size(); ++i) {
        const bool has_rival = std::any_of(discs.begin(), discs.end(), [&](const NoiseDisc& other) {
          const std::size_t number = static_cast<std::size_t>(&other - discs.data());
          const bool is_before =
              other.rank != discs[i].rank ? other.rank < discs[i].rank : number < i;
          return is_before && isCloserThanMeanOfRadii(other, discs[i]) &&
                 other.normal.dot(discs[i].normal) > kRightAngle;
        });
        EXPECT_EQ(grid.hasRival(i), has_rival) << i;
        EXPECT_EQ(finder.hasRival(i), has_rival) << i;
        rivals += has_rival;
      }
      EXPECT_GT(rivals, most > 0.1 || crowd < 1 ? 2000 : 0);
      EXPECT_LT(rivals, 5000);
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
