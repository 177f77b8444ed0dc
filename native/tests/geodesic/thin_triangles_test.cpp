// SPDX-License-Identifier: Apache-2.0
//
// Distances along surfaces whose triangles are long and thin: around poles, on sheared faces, where
// one vertex is far away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "limitsurf/geodesic/delaunay_flips.h"
#include "limitsurf/geodesic/geodesic_mesh.h"
#include "limitsurf/geodesic/guide_weights.h"
#include "limitsurf/geodesic/nearest_sources.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"

namespace limitsurf::test {
namespace {

using Locations = std::vector<Location>;

/// A sheet in a plane of square faces that are sheared by so many times their height.
Cage sheared(double shear) {
  Cage cage = fullGrid(4, 4);
  cage.positions.col(0) += shear * cage.positions.col(1);
  return cage;
}

Cage flatPole(int faces) {
  Cage cage = pole(faces);
  cage.positions.col(2).setZero();
  return cage;
}

/// A sheet with one vertex that is so far away.
Cage withSpike(double height) {
  Cage cage = fullGrid(5, 4);
  cage.positions.row(3).setConstant(height);
  return cage;
}

SurfaceTriangles trianglesOf(const Cage& cage, int level) {
  const LimitSurface surface = limitSurface(cage);
  return surfaceTriangles(surface, std::vector<int>(surface.mesh().faceCount(), level), {}, 0, {});
}

/// Twice the area of a triangle, from the lengths of its sides (Kahan's order of Heron's formula).
double doubledArea(std::array<double, 3> sides) {
  std::sort(sides.begin(), sides.end(), std::greater<>());
  const auto [a, b, c] = sides;
  return std::sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))) / 2;
}

TEST(DelaunayFlips, LeaveWellShapedTrianglesAlone) {
  EXPECT_TRUE(flippedTriangles(trianglesOf(perturbed(fullGrid(6, 6), 0.1, 3), 3)).empty());
}

TEST(DelaunayFlips, LeaveTrianglesWithoutSizeAlone) {
  Cage cage = fullGrid(3, 3);
  cage.positions.topRows(12).setZero();
  const LimitSurface surface = limitSurface(cage);
  for (const FlatTriangle& triangle : flippedTriangles(trianglesOf(cage, 3))) {
    for (const double side : triangle.sides) {
      EXPECT_GT(side, 0);
    }
  }
  const GuideWeights found = guideWeights(surface, Locations{{0, 0.5, 0.5}, {8, 0.5, 0.5}},
                                          Locations{{1, 0.25, 0.5}, {7, 0.5, 0.5}});
  for (const double distance : found.distance) {
    EXPECT_FALSE(std::isnan(distance));
  }
}

TEST(DelaunayFlips, GiveTrianglesOfTheSamePlane) {
  for (const Cage& cage : {flatPole(100), sheared(10)}) {
    const SurfaceTriangles triangles = trianglesOf(cage, 3);
    const std::vector<FlatTriangle> flipped = flippedTriangles(triangles);
    EXPECT_GT(flipped.size(), triangles.vertices.size() / 10);
    double least = 1;
    for (const FlatTriangle& triangle : flipped) {
      Vector3 corners[3];
      for (int k = 0; k < 3; ++k) {
        corners[k] = triangles.points[triangle.vertices[k]];
      }
      for (int k = 0; k < 3; ++k) {
        const double length = (corners[k] - corners[(k + 1) % 3]).norm();
        EXPECT_NEAR(triangle.sides[k], length, 1e-9 * diagonal(cage.positions));
        least = std::min(least, doubledArea(triangle.sides) / (length * length));
      }
    }
    EXPECT_GT(least, 0);
  }
}

TEST(DelaunayFlips, KeepTheArea) {
  SurfaceTriangles strip;
  constexpr int kColumns = 12;
  for (int i = 0; i <= kColumns; ++i) {
    strip.points.emplace_back(i, 0, 0);
    strip.points.emplace_back(i + 20.3, 1, 0);
  }
  for (int i = 0; i < kColumns; ++i) {
    const int a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
    strip.vertices.push_back({a, c, b});
    strip.vertices.push_back({c, d, b});
  }
  strip.is_cut.resize(strip.vertices.size(), {0, 0, 0});
  const std::vector<FlatTriangle> flipped = flippedTriangles(strip);
  ASSERT_GE(flipped.size(), strip.vertices.size() - 2);  // those at the ends may stay
  double area = 0;
  for (const FlatTriangle& triangle : flipped) {
    area += doubledArea(triangle.sides) / 2;
  }
  EXPECT_NEAR(area, static_cast<double>(flipped.size()) / 2,
              1e-9);  // each has that of a half square
  // Cut sides stay: between two of them there is nothing to flip.
  for (std::size_t triangle = 0; triangle < strip.vertices.size(); ++triangle) {
    strip.is_cut[triangle] = {1, 1, 1};
  }
  EXPECT_TRUE(flippedTriangles(strip).empty());
}

TEST(NearestSources, PassOnLittleMoreThanOnceAmongThinTriangles) {
  constexpr int kMost = 5;
  constexpr double kTimes = 2.5;  // without better shaped triangles, up to a hundred and more
  for (const Cage& cage : {pole(100), sheared(30), withSpike(1e3), withSpike(1e30)}) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<int> levels(static_cast<std::size_t>(surface.mesh().faceCount()), 4);
    const GeodesicMesh mesh(surface, levels, {}, 0, {});
    const Locations at = scatterJittered(surface, 1, 4);
    std::vector<MeshPlace> sources;
    for (const Location& place : at) {
      sources.push_back(
          {surface.evaluate(Locations{place}).position.row(0).transpose(), mesh.triangleAt(place)});
    }
    const std::vector<int> most(static_cast<std::size_t>(mesh.vertexCount()), kMost);
    const NearestSources nearest(mesh, sources, most, {});
    EXPECT_LE(static_cast<double>(nearest.timesPassedOn()), kTimes * kMost * mesh.vertexCount())
        << cage.vertexCount() << " vertices";
  }
}

/// Ways are straight, so that distances are those through the air.
TEST(GuideWeights, AreEuclideanOnFlatThinTriangles) {
  for (const Cage& cage : {flatPole(64), flatPole(200), sheared(10), sheared(30)}) {
    const LimitSurface surface = limitSurface(cage);
    Random random(5);
    const Locations at = searchedLocations(surface, 200, random);
    Locations guides;
    while (guides.size() < 8) {
      const Location guide = searchedLocations(surface, 1, random).front();
      // In the innermost triangles of a pole, places do not lie where (u, v) says.
      if (surface.evaluate(Locations{guide}).position.norm() > 0.3) {
        guides.push_back(guide);
      }
    }
    const GuideWeights found = guideWeights(surface, guides, at);
    const Points to = surface.evaluate(guides).position, from = surface.evaluate(at).position;
    const double least = diagonal(cage.positions) / 32;
    for (std::size_t i = 0; i < found.guide.size(); ++i) {
      const double truth =
          (from.row(static_cast<Eigen::Index>(i / found.count)) - to.row(found.guide[i])).norm();
      EXPECT_NEAR(found.distance[i], truth, kGuideDistanceError * std::max(truth, least))
          << cage.vertexCount() << " vertices, row " << i / found.count;
    }
  }
}

/// The innermost triangles of a pole are longer than the distance between so many guides.
TEST(GuideWeights, FindTheNearestOfManyGuidesAroundFlatPoles) {
  for (const int faces : {64, 128, 512}) {
    for (const int count : {14, 300}) {
      const Cage cage = flatPole(faces);
      const LimitSurface surface = limitSurface(cage);
      const AreaSampler sampler(surface);
      const Locations guides = sampler.uniform(count, 3);
      const Locations at = sampler.uniform(2000, 8);
      const GuideWeights found = guideWeights(surface, guides, at);
      const Points to = surface.evaluate(guides).position, from = surface.evaluate(at).position;
      for (Eigen::Index row = 0; row < from.rows(); ++row) {
        Eigen::VectorXd truth = (to.rowwise() - from.row(row)).rowwise().norm();
        const auto first = static_cast<std::size_t>(row * found.count);
        for (std::size_t i = first; i < first + static_cast<std::size_t>(found.count); ++i) {
          const double distance = truth[found.guide[i]];
          EXPECT_NEAR(found.distance[i], distance, 0.02 * std::max(distance, 1. / 8));
        }
        std::sort(truth.begin(), truth.end());
        const double last = truth[found.count - 1];
        EXPECT_NEAR(found.distance[first + static_cast<std::size_t>(found.count) - 1], last,
                    0.02 * std::max(last, 1. / 8));
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
