// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tiles/surface_tiles.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "limitsurf/surface/limit_surface.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

Eigen::Vector4d cubic(double t) {
  const double s = 1 - t;
  return Eigen::Vector4d(s * s * s, 3 * t * t * t - 6 * t * t + 4,
                         -3 * t * t * t + 3 * t * t + 3 * t + 1, t * t * t) /
         6;
}

Eigen::Vector4d cubicSlope(double t) {
  const double s = 1 - t;
  return Eigen::Vector4d(-s * s, 3 * t * t - 4 * t, -3 * t * t + 2 * t + 1, t * t) / 2;
}

struct TileValues {
  Vector3 position, by_s, by_t;
  double size;
};

/// Evaluates as the header of SurfaceTiles says.
class TileReader {
 public:
  TileReader(const SurfaceTiles& tiles, const Points& cage) : tiles_(tiles), points_(cage) {
    const auto rows = static_cast<Eigen::Index>(tiles.points_offsets.size()) - 1;
    points_.conservativeResize(cage.rows() + rows, 3);
    for (Eigen::Index row = 0; row < rows; ++row) {
      points_.row(cage.rows() + row).setZero();
      const auto r = static_cast<std::size_t>(row);
      for (auto k = static_cast<std::size_t>(tiles.points_offsets[r]);
           k < static_cast<std::size_t>(tiles.points_offsets[r + 1]); ++k) {
        points_.row(cage.rows() + row) +=
            tiles.points_weights[k] * cage.row(tiles.points_indices[k]);
      }
    }
  }

  TileValues at(std::size_t i) const {
    const auto row = static_cast<Eigen::Index>(i);
    const auto tile = static_cast<std::size_t>(tiles_.tile[i]);
    const double s = tiles_.tile_uv(row, 0), t = tiles_.tile_uv(row, 1);
    TileValues values{points_.row(tiles_.tile_anchor[tile]), Vector3::Zero(), Vector3::Zero(), 0};
    Vector3 low = Vector3::Constant(INFINITY), high = -low;
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const Vector3 control =
            points_.row(tiles_.tile_points[tile][static_cast<std::size_t>(4 * y + x)]) -
            points_.row(tiles_.tile_base[tile]);
        values.position += cubic(s)[x] * cubic(t)[y] * control;
        values.by_s += cubicSlope(s)[x] * cubic(t)[y] * control;
        values.by_t += cubic(s)[x] * cubicSlope(t)[y] * control;
        low = low.cwiseMin(control);
        high = high.cwiseMax(control);
      }
    }
    values.size = (high - low).norm();
    return values;
  }

 private:
  const SurfaceTiles& tiles_;
  Points points_;
};

/// Random places, and places near the corners of all faces.
std::vector<Location> places(const LimitSurface& surface) {
  Random random(5);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (int i = 0; i < 20; ++i) {
      at.push_back({face, random.uniform(), random.uniform()});
    }
    for (const int depth : {2, 9, 23, 40}) {
      const double near = std::ldexp(1., -depth), nearer = near * random.uniform();
      at.push_back({face, near, nearer});
      at.push_back({face, 1 - nearer, near});
      at.push_back({face, 1 - near, 1 - nearer});
      at.push_back({face, nearer, 1 - near});
    }
  }
  return at;
}

void expectTilesToEvaluate(const Cage& cage) {
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = places(surface);
  const SurfaceTiles tiles = surface.tiles(at, 64);
  const TileReader read(tiles, cage.positions);
  const Evaluation expected = surface.evaluate(at, Derivatives::first);
  const double diagonal =
      (cage.positions.colwise().maxCoeff() - cage.positions.colwise().minCoeff()).norm();
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    ASSERT_FALSE(tiles.moved[i]);
    const TileValues got = read.at(i);
    EXPECT_LE((got.position - expected.position.row(row).transpose()).norm(),
              kTilePositionError * diagonal);
    const Vector3 by_s = expected.du.row(row) / tiles.scale(row, 0);
    const Vector3 by_t = expected.dv.row(row) / tiles.scale(row, 1);
    EXPECT_LE((got.by_s - by_s).norm(), kTileDerivativeError * std::max(got.size, by_s.norm()));
    EXPECT_LE((got.by_t - by_t).norm(), kTileDerivativeError * std::max(got.size, by_t.norm()));
  }
}

TEST(SurfaceTiles, EvaluateFacesOfAnySize) {
  expectTilesToEvaluate(prism(7, true));
  expectTilesToEvaluate(mixture(4));
  expectTilesToEvaluate(tetrahedron());
}

TEST(SurfaceTiles, EvaluateOpenFansOfManyFaces) {
  for (const int faces : {1, 2, 3, 5, 9}) {
    expectTilesToEvaluate(fan(faces, false, 1));
  }
}

TEST(SurfaceTiles, EvaluateClosedFans) {
  for (const int faces : {3, 5, 8, 17}) {
    expectTilesToEvaluate(fan(faces, true, 2));
  }
}

TEST(SurfaceTiles, DoNotDependOnThePose) {
  Cage cage = perturbed(grid(3, 3), 0.2, 1);
  LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = places(surface);
  const SurfaceTiles before = surface.tiles(at);
  surface.setPositions(3 * cage.positions);
  const SurfaceTiles after = surface.tiles(at);
  EXPECT_EQ(before.points_weights, after.points_weights);
  EXPECT_EQ(before.tile_points, after.tile_points);
  EXPECT_EQ(before.tile, after.tile);
  EXPECT_EQ(before.tile_uv, after.tile_uv);
}

TEST(SurfaceTiles, RefuseDepthsOutOfRange) {
  const LimitSurface surface = limitSurface(grid(2, 2));
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  EXPECT_THROW(surface.tiles(at, 0), std::invalid_argument);
  EXPECT_THROW(surface.tiles(at, SurfaceTiles::kLargestDepth + 1), std::invalid_argument);
  EXPECT_THROW(surface.tiles(at, 5, -1), std::invalid_argument);
}

TEST(SurfaceTiles, PlacesAloneAreTheSame) {
  for (const Cage& cage : {mixture(21), fan(7, true, 1), cross()}) {
    const LimitSurface surface = limitSurface(cage);
    Random random(4);
    std::vector<Location> at;
    for (int face = 0; face < surface.faceCount(); ++face) {
      at += anywhere(face, 5, random);
      at += shells(face, random.below(4), {3, 9, 40});
      at.push_back(cornerLocation(face, random.below(4)));
    }
    for (int depth : {1, 6, 24}) {
      const SurfaceTiles tiles = surface.tiles(at, depth);
      const TilePlaces places = surface.tilePlaces(at, depth);
      EXPECT_EQ(places.tile_uv, tiles.tile_uv);
      EXPECT_EQ(places.scale, tiles.scale);
      EXPECT_EQ(places.moved, tiles.moved);
    }
    EXPECT_THROW(surface.tilePlaces(at, 0), std::invalid_argument);
  }
}

}  // namespace
}  // namespace limitsurf::test
