// SPDX-License-Identifier: Apache-2.0
//
// What searches for closest points cost, counted in patches and cores that they look into, and
// that points far away are answered as exactly as near ones.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

Cage bumpyGrid(int side) {
  Cage cage = fullGrid(side, side);
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    const double x = cage.positions(vertex, 0) / side, y = cage.positions(vertex, 1) / side;
    cage.positions(vertex, 2) = 0.1 * side * std::sin(5 * x) * std::sin(4 * y);
  }
  return cage;
}

/// The mean number of patches and cores for points as near the middle of the bumpy grid as `reach`.
double meanLeaves(const Cage& cage, int side, double reach) {
  constexpr int kCount = 400;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  Random random(1);
  Points points(kCount, 3);
  for (int i = 0; i < kCount; ++i) {
    const double x = random.uniform(0.1, 0.9), y = random.uniform(0.1, 0.9);
    points.row(i) << side * x, side * y, 0.1 * side * std::sin(5 * x) * std::sin(4 * y);
    points.row(i) += random.vector(reach).transpose();
  }
  std::int64_t leaves = 0;
  ClosestOptions options;
  options.leaves = &leaves;
  search.closest(points, options);
  return static_cast<double>(leaves) / kCount;
}

TEST(ClosestCost, TrianglesCostFewTimesWhatQuadsCost) {
  constexpr int kSide = 40;
  const Cage quads = bumpyGrid(kSide), triangles = inTriangles(bumpyGrid(kSide * 7 / 10));
  for (const double reach : {0.01, 1., 4.}) {
    const double of_quads = meanLeaves(quads, kSide, reach);
    EXPECT_LE(meanLeaves(triangles, kSide * 7 / 10, reach), 8 * of_quads) << reach;
  }
}

/// On a noisy sheet some points have no place that faces the right way. The borders, where the way
/// to a place need not be along the normal, must not be looked at by each of them.
TEST(ClosestCost, FewLeavesWhereNothingFacesTheRightWay) {
  constexpr int kSide = 40, kCount = 400;
  Cage cage = inTriangles(perturbed(bumpyGrid(kSide), 0.1, 1));
  const LimitSurface surface = limitSurface(cage);
  Random random(1);
  Points points(kCount, 3);
  for (int i = 0; i < kCount; ++i) {
    points.row(i) << random.uniform(0, kSide), random.uniform(0, kSide), 0;
  }
  std::int64_t leaves = 0;
  ClosestOptions options;
  options.leaves = &leaves;
  options.max_angle = 0.3;
  options.facing = Eigen::RowVector3d(0, 0, 1).replicate(kCount, 1);
  const Hits hits = SurfaceSearch(surface).closest(points, options);
  int in_vain = 0;
  for (const Location& at : hits.at) {
    in_vain += at.face < 0;
  }
  EXPECT_GT(in_vain, kCount / 10);
  EXPECT_LE(leaves, 100 * kCount);
}

/// Around an extraordinary vertex, the boxes of what is left of cores are as flat as the surface,
/// so that above it, where all faces are almost equally close, a search ends after some splits of
/// each.
TEST(ClosestCost, FewSplitsAboveAnExtraordinaryVertex) {
  for (const int valence : {5, 6, 9, 16}) {
    const LimitSurface surface = limitSurface(fan(valence, true, 1));
    const SurfaceSearch search(surface);
    const Evaluation at_vertex =
        surface.evaluate(std::vector<Location>{{0, 0, 0}}, Derivatives::first, true);
    constexpr int kCount = 100;
    Random random(3);
    Points points(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      points.row(i) = at_vertex.position.row(0) + 0.3 * at_vertex.normal.row(0) +
                      random.vector(1e-3).transpose();
    }
    std::int64_t leaves = 0;
    ClosestOptions options;
    options.leaves = &leaves;
    search.closest(points, options);
    EXPECT_LE(leaves, std::int64_t{20} * kCount * valence) << valence;
  }
}

/// The cost does not grow with the distance, and the result is at least as close as any of many
/// places of the surface. Squared distances are compared less that of the middle: distances
/// themselves could not tell the places apart.
TEST(ClosestCost, FarPointsCostNoMoreAndAreAnsweredAsExactly) {
  for (const Cage& cage : {cube(), torus(12, 8), bumpyGrid(10), inTriangles(bumpyGrid(10)), cross(),
                           pole(40), fan(5, false, 3)}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Eigen::RowVector3d low = cage.positions.colwise().minCoeff(),
                             high = cage.positions.colwise().maxCoeff();
    const Vector3 middle = 0.5 * (low + high).transpose();
    const double diagonal = (high - low).norm();
    std::vector<Location> places;
    for (int face = 0; face < surface.faceCount(); ++face) {
      for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) places.push_back({face, i / 8., j / 8.});
      }
    }
    const Points samples = surface.evaluate(places).position;
    Random random(2);
    for (const double far : {10., 15.9, 16.1, 1e3, 1e8, 1e15, 1e40, 1e140}) {
      constexpr int kCount = 25;
      Points points(kCount, 3);
      for (int i = 0; i < kCount; ++i) {
        points.row(i) = (middle + far * diagonal * random.vector(1).normalized()).transpose();
      }
      std::int64_t leaves = 0;
      ClosestOptions options;
      options.leaves = &leaves;
      const Hits hits = search.closest(points, options);
      EXPECT_LE(leaves, 60 * kCount) << far;
      for (int i = 0; i < kCount; ++i) {
        ASSERT_GE(hits.at[static_cast<std::size_t>(i)].face, 0) << far;
        const Vector3 away = points.row(i).transpose() - middle;
        const double range = away.norm();
        // The distance less that of the middle.
        const auto excess = [&](const Eigen::RowVector3d& p) {
          const Vector3 offset = p.transpose() - middle;
          return offset.dot(offset / (2 * range) - away / range);
        };
        const double found = excess(hits.position.row(i));
        for (Eigen::Index k = 0; k < samples.rows(); ++k) {
          ASSERT_LE(found, excess(samples.row(k)) + 1e-12 * diagonal) << far;
        }
      }
    }
  }
}

/// On a long and narrow mesh the tangents of a patch are nearly parallel, so that no bound shows
/// where the squared distance is convex.
TEST(ClosestStretched, PointsOfTheSurfaceAreFound) {
  for (const double length : {1e2, 1e3, 1e4}) {
    Cage cage = grid(1, 1);
    cage.positions << 0, 0, 0, length, 0, 0.2, 0, 1, 0.3, length, 1, -0.1;
    const LimitSurface surface = limitSurface(inTriangles(cage));
    const SurfaceSearch search(surface);
    Random random(4);
    std::vector<Location> places;
    for (int i = 0; i < 12; ++i) {
      places.push_back({random.below(surface.faceCount()), random.uniform(), random.uniform()});
    }
    const Hits hits = search.closest(surface.evaluate(places).position);
    EXPECT_LE(hits.distance.maxCoeff(), 1e-12 * length) << length;
  }
}

/// One vertex that is far away makes the diagonal so long that in single precision, relative to the
/// middle of the mesh, all other faces are in one place: searches looked at all of them.
TEST(ClosestCost, OneFarVertexDoesNotHideTheOthers) {
  constexpr int kSide = 20, kCount = 100;
  for (const double far : {1e6, 1e8, 1e10}) {
    Cage cage = bumpyGrid(kSide);
    cage.positions.row(219) += far * Eigen::RowVector3d(-0.79, 1.95, 1.1);
    const LimitSurface surface = limitSurface(inTriangles(cage));
    const double allowed = kSearchError * diagonal(cage.positions);
    Random random(1);
    Points points(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      points.row(i) << random.uniform(-2, 22), random.uniform(-2, 22), random.uniform(-5, 5);
    }
    std::int64_t leaves = 0;
    ClosestOptions options;
    options.leaves = &leaves;
    const Hits hits = SurfaceSearch(surface).closest(points, options);
    EXPECT_LE(leaves, 400 * kCount) << far;
    std::vector<Location> places;
    for (int face = 0; face < surface.faceCount(); ++face) {
      places.push_back({face, random.uniform(), random.uniform()});
    }
    const Points samples = surface.evaluate(places).position;
    for (int i = 0; i < kCount; ++i) {
      const double least = (samples.rowwise() - points.row(i)).rowwise().norm().minCoeff();
      EXPECT_LE(hits.distance[i], least + allowed) << far;
    }
  }
}

/// On faces that are nearly on a line in space, many places are almost equally close. A fit of a
/// path there makes thousands of searches, of which many looked at 2^17 cells.
TEST(ClosestStretched, FewCellsOnFacesNearlyOnALine) {
  constexpr int kFaces = 3, kCount = 60;
  const Vector3 direction(0.6, -0.3, 0.7);
  for (const double noise : {1e-6, 1e-9, 1e-11, 1e-12, 3e-13, 1e-13, 1e-14}) {
    Random random(5);
    Cage cage = fullGrid(kFaces, 1);
    for (int v = 0; v < cage.vertexCount(); ++v) {
      cage.positions.row(v) = (random.uniform() * direction + random.vector(noise)).transpose();
    }
    const LimitSurface surface = limitSurface(cage);
    std::vector<Location> places;
    for (int i = 0; i < kCount; ++i) {
      places.push_back({random.below(kFaces), random.uniform(), random.uniform()});
    }
    Points points = surface.evaluate(places).position;
    Points moves(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      moves.row(i) = random.vector(i % 4 * noise).transpose();
    }
    points += moves;
    std::int64_t cells = 0;
    ClosestOptions options;
    options.cells = &cells;
    const Hits hits = SurfaceSearch(surface).closest(points, options);
    EXPECT_LE(cells, 1000 * kCount) << noise;
    for (int i = 0; i < kCount; ++i) {
      EXPECT_LE(hits.distance[i], moves.row(i).norm() + kSearchError) << noise;
    }
  }
}

/// Points on normals of a flat grid, above its vertices and edges: of the faces that meet there at
/// least one has the foot, although rounding decides towards which side the distance falls.
TEST(ClosestFar, FacingFindsFeetOnEdges) {
  Random random(3);
  int feet = 0;
  for (int round = 0; round < 40; ++round) {
    Cage cage = grid(4, 4);
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 2)
            .normalized()
            .toRotationMatrix();
    for (int v = 0; v < cage.vertexCount(); ++v) {
      const Vector3 flat(cage.positions(v, 0), cage.positions(v, 1), 0);
      cage.positions.row(v) = (0.25 * turn * flat).transpose();
    }
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    std::vector<Location> places;
    for (int face = 0; face < surface.faceCount(); ++face) {
      for (int i = 0; i < 9; ++i) places.push_back({face, (i % 3) / 2., (i / 3) / 2.});
    }
    const Points on = surface.evaluate(places).position;
    const Vector3 normal = turn.col(2);
    for (const double far : {30., 141., 424., 1e4, 1e9}) {
      ClosestOptions options;
      options.facing = normal.transpose().replicate(on.rows(), 1);
      options.max_angle = 1.2;
      const Points points = on.rowwise() + far * normal.transpose();
      const Hits all = search.closest(points), hits = search.closest(points, options);
      for (Eigen::Index i = 0; i < on.rows(); ++i) {
        ASSERT_GE(hits.at[static_cast<std::size_t>(i)].face, 0) << far;
        EXPECT_LE(hits.distance[i], all.distance[i] + 1e-12 + 4e-16 * far) << far;
        ++feet;
      }
    }
  }
  EXPECT_GT(feet, 10000);
}

TEST(ClosestFar, TheGreatestDistanceCountsBeyondAllMeasure) {
  const LimitSurface surface = limitSurface(grid(2, 2));
  const SurfaceSearch search(surface);
  for (const double far : {1e3, 1e17, 1e20, 1e30, 1e100}) {
    const Points point = Eigen::RowVector3d(0, 0, far);
    ClosestOptions options;
    options.max_distance = far / 2;
    EXPECT_EQ(search.closest(point, options).at[0].face, -1) << far;
    options.max_distance = 2 * far;
    EXPECT_GE(search.closest(point, options).at[0].face, 0) << far;
  }
}

}  // namespace
}  // namespace limitsurf::test
