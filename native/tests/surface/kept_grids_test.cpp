// SPDX-License-Identifier: Apache-2.0
//
// The control grids of ring tiles are made when they are first needed, by any thread, with the same
// bits whoever asks for how many steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tiled_surface.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

TEST(StepsMade, OnlyOneHasATileAndOthersReadWhatWasMadeBefore) {
  const StepsMade steps(2);
  EXPECT_FALSE(steps.has(0, 1));
  EXPECT_EQ(steps.claim(0), 0);
  EXPECT_EQ(steps.claim(0), StepsMade::kClaimedByOther);
  EXPECT_EQ(steps.claim(1), 0);
  steps.put(0, 2);
  EXPECT_TRUE(steps.has(0, 2));
  EXPECT_FALSE(steps.has(0, 3));
  EXPECT_EQ(steps.claim(0), 2);
  EXPECT_TRUE(steps.has(0, 2));
  EXPECT_EQ(steps.claim(0), StepsMade::kClaimedByOther);
}

TEST(StepsMade, AreForgotten) {
  StepsMade steps(1);
  steps.claim(0);
  steps.put(0, 4);
  steps.claim(0);
  steps.clear();
  EXPECT_FALSE(steps.has(0, 1));
  EXPECT_EQ(steps.claim(0), 0);
}

class KeptGrids : public testing::Test {
 protected:
  KeptGrids() : surface_(limitSurface(mixture(7))), tiles_(surface_.mesh()), all_(tiles_.table) {
    all_.set(surface_.positions(), 1);
  }

  int tileCount() const { return static_cast<int>(tiles_.table.ring_tiles.size()); }
  int steps(int tile) const { return all_.gridSteps(tiles_.table.ring_tiles[tile]); }
  /// Whether these are the grids that are made all at once.
  bool areThose(const Pose::Grid grids[], int tile, int count) {
    const Pose::Grid* const whole = all_.grids(tile, steps(tile), own_);
    for (int step = 0; step < count; ++step) {
      for (int slot = 0; slot < tile_grid::kSlots; ++slot) {
        if (!std::equal(grids[step].points[slot].data(), grids[step].points[slot].data() + 4,
                        whole[step].points[slot].data())) {
          return false;
        }
      }
    }
    return true;
  }

  LimitSurface surface_;
  TiledSurface tiles_;
  Pose all_;
  Pose::OwnGrids own_;
};

TEST_F(KeptGrids, DoNotDependOnHowManyAreMadeAtATime) {
  Pose pose(tiles_.table);
  pose.set(surface_.positions(), 1);
  Pose::OwnGrids own;
  for (int tile = 0; tile < tileCount(); ++tile) {
    for (const int step : {1, 3, 2, 4}) {
      const int asked = std::min(step, steps(tile));
      ASSERT_TRUE(areThose(pose.grids(tile, asked, own), tile, asked)) << tile << ", " << step;
    }
  }
  EXPECT_TRUE(own.empty());  // nobody else was making them
}

TEST_F(KeptGrids, FollowThePose) {
  Pose pose(tiles_.table);
  Pose::OwnGrids own;
  pose.set(2 * surface_.positions(), 1);
  pose.grids(0, steps(0), own);
  EXPECT_FALSE(areThose(pose.grids(0, 1, own), 0, 1));
  pose.set(surface_.positions(), 1);
  EXPECT_TRUE(areThose(pose.grids(0, steps(0), own), 0, steps(0)));
}

TEST_F(KeptGrids, AreTheSameForThreadsThatAskAtTheSameTime) {
  constexpr int kThreads = 4, kPoses = 50;
  Pose pose(tiles_.table);
  for (int i = 0; i < kPoses; ++i) {
    pose.set(surface_.positions(), 1);
    std::vector<std::vector<Pose::Grid>> seen(kThreads);
    std::vector<std::thread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        Pose::OwnGrids own;
        for (int tile = 0; tile < tileCount(); ++tile) {
          const int asked = 1 + (t + tile) % steps(tile);
          const Pose::Grid* const grids = pose.grids(tile, asked, own);
          seen[t].insert(seen[t].end(), grids, grids + asked);
        }
      });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    for (int t = 0; t < kThreads; ++t) {
      const Pose::Grid* grids = seen[t].data();
      for (int tile = 0; tile < tileCount(); ++tile) {
        const int asked = 1 + (t + tile) % steps(tile);
        ASSERT_TRUE(areThose(grids, tile, asked)) << t << ", " << tile;
        grids += asked;
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
