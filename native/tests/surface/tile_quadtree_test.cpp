// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/tile_quadtree.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "support/cages/meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// The tile that the quadtrees lead to, as the header of TileQuadtree says.
int tileAt(const TileQuadtree& tree, const Location& at) {
  int node = at.face, steps = 0;
  double u = at.u, v = at.v;
  while (tree.child[static_cast<std::size_t>(node)] >= 0) {
    const int a = u >= 0.5, b = v >= 0.5;
    node = tree.child[static_cast<std::size_t>(node)] + 2 * b + a;
    u = 2 * u - a;
    v = 2 * v - b;
    ++steps;
  }
  EXPECT_LE(steps, tree.levels);
  return -1 - tree.child[static_cast<std::size_t>(node)];
}

/// The tile of each of many random places has to be the one that tiles() gives.
void expectTheTilesOfPlaces(const Cage& cage, int max_depth) {
  const LimitSurface surface = limitSurface(cage);
  const TileQuadtree tree = tileQuadtree(surface, max_depth);
  std::vector<Eigen::RowVector2d> scale(tree.tiles.tile_points.size());
  for (std::size_t i = 0; i < tree.tiles.tile.size(); ++i) {
    scale[static_cast<std::size_t>(tree.tiles.tile[i])] =
        tree.tiles.scale.row(static_cast<Eigen::Index>(i));
  }
  Random random(3);
  std::vector<Location> at;
  for (int i = 0; i < 2000; ++i) {
    const double near = std::ldexp(1., -random.below(max_depth));
    at.push_back({random.below(surface.faceCount()), near * random.uniform(),
                  i % 2 == 0 ? random.uniform() : near * random.uniform()});
  }
  const SurfaceTiles expected = surface.tiles(at, max_depth);
  int compared = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (expected.moved[i]) {
      continue;
    }
    const int tile = tileAt(tree, at[i]);
    ASSERT_GE(tile, 0);
    ASSERT_LT(tile, static_cast<int>(scale.size()));
    EXPECT_EQ(scale[static_cast<std::size_t>(tile)], expected.scale.row(row));
    const Eigen::RowVector2d uv(at[i].u, at[i].v);
    const Eigen::RowVector2d in_tile =
        (uv - tree.origin.row(tile)).cwiseProduct(scale[static_cast<std::size_t>(tile)]);
    EXPECT_LE((in_tile - expected.tile_uv.row(row)).cwiseAbs().maxCoeff(), 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 1500);
}

TEST(SlowTileQuadtree, LeadsToTheTilesOfPlaces) {
  for (const int depth : {6, 24}) {
    expectTheTilesOfPlaces(grid(3, 3), depth);
    expectTheTilesOfPlaces(cross(), depth);
    expectTheTilesOfPlaces(mixture(4), depth);
    expectTheTilesOfPlaces(fan(9, false, 1), depth);
    expectTheTilesOfPlaces(fan(5, true, 2), depth);
  }
}

TEST(TileQuadtree, HasTheSmallestTilesThatItsDepthAllows) {
  const LimitSurface surface = limitSurface(fan(5, true, 2));
  int before = 0;
  for (const int depth : {3, 4, 9, 20}) {
    const TileQuadtree tree = tileQuadtree(surface, depth);
    EXPECT_GT(tree.levels, before);
    EXPECT_LE(tree.levels, depth + 1);
    before = tree.levels;
  }
}

TEST(TileQuadtree, IsTheSameForAllNumbersOfThreads) {
  const LimitSurface surface = limitSurface(mixture(2));
  const TileQuadtree one = tileQuadtree(surface, 6, 1), two = tileQuadtree(surface, 6, 2);
  EXPECT_EQ(one.child, two.child);
  EXPECT_EQ(one.origin, two.origin);
  EXPECT_EQ(one.tiles.tile_points, two.tiles.tile_points);
}

TEST(TileQuadtree, RefusesDepthsOutOfRange) {
  const LimitSurface surface = limitSurface(grid(2, 2));
  EXPECT_THROW(tileQuadtree(surface, 0), std::invalid_argument);
  EXPECT_THROW(tileQuadtree(surface, SurfaceTiles::kLargestDepth + 1), std::invalid_argument);
}

TEST(TileQuadtree, RefusesMoreWeightsThanThereIsRoomFor) {
  const LimitSurface surface = limitSurface(ngon(600, 1));
  bool any_part_of_the_tiles = false;
  EXPECT_THROW(
      tileQuadtree(surface, 24, 1, [&](double part) { any_part_of_the_tiles |= part > 0.5; }),
      std::invalid_argument);
  EXPECT_FALSE(any_part_of_the_tiles) << "it is known before the tiles are made";
}

TEST(TileQuadtree, TellsProgressWhileTilesAreMade) {
  const LimitSurface surface = limitSurface(ngon(80, 1));
  std::vector<double> parts;
  tileQuadtree(surface, 16, 1, [&](double part) { parts.push_back(part); });
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_TRUE(
      std::any_of(parts.begin(), parts.end(), [](double part) { return part > 0.5 && part < 1; }));
  EXPECT_EQ(parts.back(), 1);
}

}  // namespace
}  // namespace limitsurf::test
