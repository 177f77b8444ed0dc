// SPDX-License-Identifier: Apache-2.0
//
// What an interruption leaves behind, whenever it comes.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "limitsurf/eigen/eigenbasis.h"
#include "limitsurf/flow/curve_directions.h"
#include "limitsurf/geodesic/guide_weights.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/path/path_smoothing.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/search/box_tree.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/surface/strands/frame_rows.h"
#include "limitsurf/surface/surface_data.h"
#include "support/cages/cage.h"
#include "support/cages/meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

struct Interrupted {};

/// Calls call() again and again, ended at the first pass of an interruption point, at the second
/// one, at the fourth and so on, until it is not ended any more. Returns how often it was.
template <typename Call, typename Check>
int interruptedAtAll(const Call& call, const Check& check) {
  int times = 0;
  for (long last = 1;; last *= 2) {
    long passes = 0;
    try {
      const InterruptionPoint point([&] {
        if (++passes == last) {
          throw Interrupted();
        }
      });
      call();
      return times;
    } catch (const Interrupted&) {
      ++times;
      check();
    }
  }
}

std::vector<Location> middles(const LimitSurface& surface) {
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    at.push_back({face, 0.25, 0.4});
  }
  return at;
}

Cage creasedGrid() {
  Cage cage = fullGrid(40, 40);
  for (int i = 0; i < 40; ++i) {
    cage.options.edge_sharpness.edges.emplace_back(i + 41 * 20, i + 1 + 41 * 20);
    cage.options.edge_sharpness.values.push_back(1.5 + i % 3);
  }
  return cage;
}

TEST(Interruption, OfTheConstructorLeavesTheMeshUsable) {
  const ControlMesh mesh = controlMesh(creasedGrid());
  EXPECT_GT(interruptedAtAll([&] { LimitSurface surface(mesh); }, [] {}), 3);
  EXPECT_EQ(LimitSurface(mesh).faceCount(), 1600);
}

// A basis takes some 20 microseconds a face, and more than a second where many thousand faces meet.
TEST(Interruption, IsPossibleWhileABasisIsMade) {
  // One thread does all of it: the share of one of several is up to chance.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  for (const RingKind kind : {RingKind::interior, RingKind::pinned, RingKind::dart}) {
    const Ring ring{kind, 3000};
    long passes = 0;
    const InterruptionPoint point([&] { ++passes; });
    const Eigenbasis basis(ring);
    EXPECT_GE(passes, ring.faces / 256) << static_cast<int>(kind);
  }
}

long passesOf(const std::function<void()>& call) {
  long passes = 0;
  const InterruptionPoint point([&] { ++passes; });
  call();
  return passes;
}

TEST(Interruption, IsPossibleWhileATreeIsMade) {
  std::vector<BoxF> leaves;
  Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    Box box;
    box.include(random.vector(1));
    leaves.emplace_back(box);
  }
  std::vector<std::int32_t> order;
  // Each level of the tree looks at all leaves, and more than 17 levels are needed. One thread does
  // all of it: the share of one of several is up to chance.
  EXPECT_GE(passesOf([&] { BoxTree tree(leaves, order, 1); }), 17 * 200'000 / (1 << 17));
}

TEST(Interruption, IsPossibleWithinOneTaskOfASearch) {
  Cage sheets;
  sheets.positions.resize(4 * 300, 3);
  for (int sheet = 0; sheet < 300; ++sheet) {
    sheets.positions.middleRows<4>(4 * sheet) << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
    sheets.faces.push_back({4 * sheet, 4 * sheet + 1, 4 * sheet + 2, 4 * sheet + 3});
  }
  const LimitSurface surface = limitSurface(sheets);
  const SurfaceSearch search(surface, 1);
  Points points(400, 3);  // one task
  Random random(2);
  for (int row = 0; row < points.rows(); ++row) points.row(row) = random.vector(1);
  std::int64_t leaves = 0;
  ClosestOptions options;
  options.leaves = &leaves;
  const long passes = passesOf([&] { search.closest(points, options, 1); });
  ASSERT_GE(leaves, 100'000);
  EXPECT_GE(passes, leaves / 4096);
}

// Where thousands of faces meet, a tile and a stencil have thousands of weights.
TEST(Interruption, IsPossibleBetweenTilesOfPoles) {
  const LimitSurface surface = limitSurface(fan(3000, true, 1));
  std::vector<Location> at;
  for (int face = 0; face < 64; ++face) {
    at.push_back({face, 0.01, 0.01});
  }
  // For each tile one when it is made for the last time, and one for each task of four.
  EXPECT_GE(passesOf([&] { surface.tiles(at, 8, 1); }), 64 + 64 / 4);
  EXPECT_GE(passesOf([&] { surface.stencils(at, true, 1); }), 64 / 8);
}

/// Short straight curves on a sheet of 30 x 30 squares.
Polylines shortCurves(int count) {
  Random random(7);
  Polylines curves{Points(2 * count, 3), {0}};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(1, 29), y = random.uniform(1, 29);
    curves.points.row(2 * i) << x, y, 0;
    curves.points.row(2 * i + 1) << x + 0.1, y, 0;
    curves.offsets.push_back(2 * i + 2);
  }
  return curves;
}

TEST(Interruption, IsPossibleBetweenCurves) {
  constexpr int kCurves = 5000;
  const LimitSurface surface = limitSurface(fullGrid(30, 30));
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  GuideOptions options;
  options.cut_curves = shortCurves(kCurves);
  EXPECT_GE(passesOf([&] { guideWeights(surface, at, at, options); }), 2 * kCurves);
  const long few = passesOf([&] { curveDirections(surface, shortCurves(1), at); });
  const long many = passesOf([&] { curveDirections(surface, shortCurves(kCurves), at); });
  EXPECT_GE(many - few, 2 * kCurves / 256);
}

TEST(Interruption, IsPossibleBetweenEdges) {
  const Cage cage = fullGrid(100, 100);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  GuideOptions options;
  const long without = passesOf([&] { guideWeights(surface, at, at, options); });
  for (const std::vector<int>& face : cage.faces) {
    options.cuts.emplace_back(face[0], face[1]);
  }
  // The edges are sorted, which compares each with a dozen others at least.
  EXPECT_GE(passesOf([&] { guideWeights(surface, at, at, options); }) - without,
            static_cast<long>(12 * options.cuts.size() / 256));
}

TEST(Interruption, IsPossibleBetweenPointsOfAPath) {
  const LimitSurface surface = limitSurface(fullGrid(3, 3));
  const SurfaceSearch search(surface);
  const std::vector<Location> path = {{0, 0.5, 0.5}, {8, 0.5, 0.5}};
  const auto passes = [&](int count) {
    return passesOf([&] { evenPath(surface, search, path, count, 1); });
  };
  EXPECT_GE(passes(200'000) - passes(2), 2 * 200'000 / 256);
}

TEST(Interruption, IsPossibleWithinAStrand) {
  const Points root = Points::Zero(1, 3), along = Points::Ones(1, 3);
  EXPECT_GE(passesOf([&] { straightStrands(root, along, 1'000'000, 1); }), 15);
}

// Memory for gigabytes takes seconds: it comes in parts of 8 MiB at most.
TEST(Interruption, IsHeardWhileAVectorTakesMemory) {
  constexpr std::size_t kPart = std::size_t{8} << 20;  // bytes
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3'000'000}}) {
    std::vector<Location> places;
    const long passes = passesOf([&] { resizeInParts(places, count); });
    EXPECT_GE(passes, static_cast<long>(count * sizeof(Location) / kPart));
    ASSERT_EQ(places.size(), count);
    EXPECT_EQ(places.capacity(), count);
    for (const Location& place : places) {
      ASSERT_TRUE(place.face == -1 && place.u == 0 && place.v == 0);
    }
  }
  std::vector<int> numbers = {3, 4};
  resizeInParts(numbers, 4);
  EXPECT_EQ(numbers, (std::vector<int>{3, 4, 0, 0}));

  const LimitSurface surface = limitSurface(fullGrid(1, 1));
  constexpr std::size_t kSide = 2048, kPlaces = kSide * kSide;
  std::vector<Location> places;
  const long passes =
      passesOf([&] { places = scatterJittered(surface, static_cast<int>(kSide), 0, 1); });
  ASSERT_EQ(places.size(), kPlaces);
  constexpr std::size_t kTasks = kPlaces / 8192;  // each passes as well
  EXPECT_GE(passes, static_cast<long>(kTasks + kPlaces * sizeof(Location) / kPart));
}

// At a vertex with thousands of faces a row takes milliseconds, and thousands of rows are one task.
TEST(Interruption, IsHeardBetweenRowsNextToALargeVertex) {
  constexpr int kFaces = 1200, kRows = 30;
  const LimitSurface surface = limitSurface(pole(kFaces));
  std::vector<Location> at;  // the first corners of the Ptex faces 0, 3, 6, ... are at the pole
  for (int row = 0; row < kRows; ++row) {
    at.push_back({3 * row, 1e-9, 2e-9});
  }
  EXPECT_GE(passesOf([&] { surface.evaluate(at, Derivatives::first, true, 1); }), kRows);
  EXPECT_GE(passesOf([&] { surface.evaluate(at, Derivatives::second, true, 1); }), kRows);
  EXPECT_GE(passesOf([&] { surface.frames(at, 1); }), kRows);
}

TEST(Interruption, OfAPoseIsToldAndHealedByTheNextPose) {
  LimitSurface surface = limitSurface(creasedGrid());
  const Points before = surface.positions(), after = (2 * before.array() + 1).matrix();
  const std::vector<Location> at = middles(surface);
  const Points expected = surface.evaluate(at, Derivatives::none).position;
  int halves = 0;
  const int times = interruptedAtAll(
      [&] {
        surface.setPositions(before);
        surface.setPositions(after);
      },
      [&] {
        halves += !surface.isPosed();
        surface.setPositions(before);
        EXPECT_TRUE(surface.isPosed());
        EXPECT_EQ(surface.evaluate(at, Derivatives::none).position, expected);
      });
  EXPECT_GT(times, 3);
  EXPECT_GT(halves, 0);
}

TEST(Interruption, OfValuesIsToldAndHealedByTheNextValues) {
  const LimitSurface surface = limitSurface(creasedGrid());
  const DataRows before = DataRows::Random(surface.positions().rows(), 7);
  const DataRows after = DataRows::Random(surface.positions().rows(), 7);
  SurfaceData data = surface.vertexData(before);
  const std::vector<Location> at = middles(surface);
  const DataRows expected = data.evaluate(at).value;
  int halves = 0;
  const int times = interruptedAtAll([&] { data.setValues(after); },
                                     [&] {
                                       halves += !data.isSet();
                                       data.setValues(before);
                                       EXPECT_TRUE(data.isSet());
                                       EXPECT_EQ(data.evaluate(at).value, expected);
                                     });
  EXPECT_GT(times, 3);
  EXPECT_EQ(halves, times);
}

}  // namespace
}  // namespace limitsurf::test
