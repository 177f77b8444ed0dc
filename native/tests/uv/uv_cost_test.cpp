// SPDX-License-Identifier: Apache-2.0
//
// The cost of inverting a UV map is bounded where a value lies far from all others: the faces
// around it are then so stretched that nearly every cell of theirs is degenerate, and covers
// everything.
#include <gtest/gtest.h>

#include "limitsurf/interruption_point.h"
#include "limitsurf/uv/uv_map.h"
#include "limitsurf/uv/uv_patches.h"
#include "limitsurf/uv/uv_raster.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

constexpr int kColumns = 5, kRows = 4;

LimitSurface grid() {
  Points positions(kColumns * kRows, 3);
  std::vector<std::int64_t> vertices;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      positions.row(kColumns * y + x) << x, y, 0.25 * ((7 * x + 3 * y) % 5);
      if (x + 1 < kColumns && y + 1 < kRows) {
        const int corner = kColumns * y + x;
        vertices.insert(vertices.end(),
                        {corner, corner + 1, corner + kColumns + 1, corner + kColumns});
      }
    }
  }
  const std::vector<std::int64_t> sizes(vertices.size() / 4, 4);
  return LimitSurface(ControlMesh(positions, sizes, vertices, {}));
}

/// Values between -4 and 4, but one that is `size` times as far away, in both coordinates or in
/// one.
DataRows valuesWithAStray(Random& random, double size) {
  DataRows values(kColumns * kRows, 2);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values.data()[i] = random.uniform(-4, 4);
  }
  const Eigen::Index row = random.below(values.rows());
  values(row, 0) *= size;
  values(row, 1) *= random.below(2) == 0 ? size : 1;
  return values;
}

struct Searched {
  LatticeInverse::Work work;
  std::int64_t found = 0;
  double error = 0;  // of the places found, relative to the map's extent
};

/// Searches for `side` x `side` texels of the unit square.
Searched search(const LimitSurface& surface, const DataRows& values, int side) {
  const SurfaceData data = surface.vertexData(values, 1);
  const UvPatches map(data, 1);
  const Lattice lattice{0, 0, side - 1, side - 1};
  const PlaneFrame frame{Point2::Zero(), Point2::Constant(side), -0.5};
  std::vector<LatticeFinds::Slot> slots;
  LatticeFinds finds(lattice, slots);
  LatticeInverse inverse(lattice, map.tolerance() * frame.scale, finds);
  for (const UvPiece& piece : map.pieces()) {
    map.invert(piece, frame, inverse, finds);
  }
  finds.finish();
  Searched result{inverse.work()};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const LatticeFinds::Slot& slot = finds.at(x, y);
      if (slot.face >= 0) {
        const Location at{slot.face, slot.u, slot.v};
        const Eigen::RowVector2d texel((x + 0.5) / side, (y + 0.5) / side);
        const double error = (data.evaluate({&at, 1}).value - texel).norm();
        result.error = std::max(result.error, error / map.extent());
        ++result.found;
      }
    }
  }
  return result;
}

TEST(UvCost, StrayValuesCostLittle) {
  const LimitSurface surface = grid();
  std::int64_t found = 0;
  for (const double size : {1e6, 1e9}) {
    for (int seed = 0; seed < 12; ++seed) {
      SCOPED_TRACE(std::to_string(size) + " " + std::to_string(seed));
      Random random(seed);
      const Searched result = search(surface, valuesWithAStray(random, size), 64);
      found += result.found;
      EXPECT_LE(result.error, kMapError);
      // Without the stray value there are some thousand cells, and no searches.
      EXPECT_LE(result.work.divided, 20'000);
      EXPECT_LE(result.work.searches, 10'000);
    }
  }
  EXPECT_GT(found, 12 * 64 * 64);
}

TEST(UvCost, IsBoundedWhereTheErrorExceedsATexel) {
  const LimitSurface surface = grid();
  for (int seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Searched result = search(surface, valuesWithAStray(random, 1e13), 48);
    EXPECT_LE(result.error, kMapError);
    EXPECT_LE(result.work.divided, 30'000);
    EXPECT_LE(result.work.searches, 60'000);
  }
}

// The lower edge of the map is one point, and that point is searched for.
TEST(UvCost, CollapsedEdgesCostLittle) {
  const LimitSurface surface = grid();
  for (const double span : {1., 3., 6.}) {
    for (const Interpolation interpolation :
         {Interpolation::none, Interpolation::boundaries, Interpolation::all}) {
      SCOPED_TRACE(std::to_string(span) + " " + std::to_string(static_cast<int>(interpolation)));
      DataRows values(kColumns * kRows, 2);
      std::vector<std::int64_t> corners;
      for (int i = 0; i < kColumns * kRows; ++i) {
        const double angle = span * (i % kColumns) / (kColumns - 1), far = i / kColumns;
        values.row(i) << 0.3 + far * std::cos(angle), 0.2 + far * std::sin(angle);
      }
      for (int y = 0; y + 1 < kRows; ++y) {
        for (int x = 0; x + 1 < kColumns; ++x) {
          const int corner = kColumns * y + x;
          for (const int vertex : {corner, corner + 1, corner + kColumns + 1, corner + kColumns}) {
            corners.push_back(vertex);
          }
        }
      }
      const SurfaceData data = surface.faceVarying(values, corners, interpolation);
      const UvPatches map(data, 1);
      const Location on_edge{1, 0.3, 0};
      const Eigen::RowVector2d point = data.evaluate({&on_edge, 1}).value.row(0);
      constexpr Lattice kOnePoint{0, 0, 0, 0};
      const PlaneFrame frame{point.transpose().array(), Point2::Ones(), 0};
      std::vector<LatticeFinds::Slot> slots;
      LatticeFinds finds(kOnePoint, slots);
      LatticeInverse inverse(kOnePoint, Point2::Constant(map.tolerance()), finds);
      for (const UvPiece& piece : map.pieces()) map.invert(piece, frame, inverse, finds);
      finds.finish();
      EXPECT_GE(finds.at(0, 0).face, 0);
      // Four faces have the edge. One square cell after the other along it would be thousands.
      EXPECT_LE(inverse.work().divided, 5'000);
      EXPECT_LE(inverse.work().searches, 200);
    }
  }
}

/// The borders of a map that folds over itself are long, and they are prepared before the first
/// texel is looked for.
TEST(UvCost, BordersAreInterruptibleWhileTheyArePrepared) {
  const LimitSurface surface = grid();
  Random random(2);
  DataRows values(kColumns * kRows, 2);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values.data()[i] = random.uniform(0, 1);
  }
  const SurfaceData data = surface.vertexData(values, 1);
  const UvMap map(data, 1);
  RasterOptions options;
  options.width = options.height = 400;
  int passes[2] = {};
  for (const int margin : {0, 1}) {
    options.margin = 20 * margin;
    const InterruptionPoint point([&] { ++passes[margin]; });
    map.rasterize(options, 1);
  }
  EXPECT_GT(passes[1], passes[0] + 100);
}

}  // namespace
}  // namespace limitsurf::test
