// SPDX-License-Identifier: Apache-2.0
//
// Closest points on surfaces that are squeezed so much that du and dv are nearly parallel. There
// the squared distance is convex in a narrow band only.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/truth/brute_force.h"

namespace limitsurf::test {
namespace {

Eigen::Matrix3d rotation(Random& random) {
  return Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1)
      .normalized()
      .toRotationMatrix();
}

enum class Shape { flat, wavy, rough };
enum class Squeeze { along_y, in_plane, anywhere };

/// An irregular grid, squeezed along a direction of space and turned.
Cage squeezedCage(Shape shape, bool triangles, Squeeze squeeze, double factor, Random& random) {
  Cage cage = fullGrid(4, 4);
  for (int v = 0; v < cage.vertexCount(); ++v) {
    cage.positions(v, 0) += random.uniform(-0.25, 0.25);
    cage.positions(v, 1) += random.uniform(-0.25, 0.25);
    cage.positions(v, 2) = shape == Shape::flat   ? 0
                           : shape == Shape::wavy ? 0.4 * std::sin(cage.positions(v, 0)) *
                                                        std::cos(cage.positions(v, 1))
                                                  : random.uniform(-0.2, 0.2);
  }
  Eigen::Matrix3d map = Vector3(1, factor, 1).asDiagonal();
  if (squeeze != Squeeze::along_y) {
    const Eigen::Matrix3d turn = squeeze == Squeeze::anywhere
                                     ? rotation(random)
                                     : Eigen::AngleAxisd(0.7, Vector3::UnitZ()).toRotationMatrix();
    map = rotation(random) * map * turn;
  }
  cage.positions = (cage.positions * map.transpose()).eval();
  return triangles ? inTriangles(cage) : cage;
}

/// Searches from points on normals of known places, nearer to these than their centres of
/// curvature: so each place is a foot. Returns how many searches there were.
int expectPlacesFound(const Cage& cage, bool brute_force, const std::string& name, Random& random) {
  constexpr int kPlaces = 4;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  const double diagonal = test::diagonal(cage.positions), allowed = kSearchError * diagonal;
  std::vector<Location> places;
  for (int i = 0; i < kPlaces; ++i) {
    places.push_back({random.below(surface.faceCount()), random.uniform(0.01, 0.99),
                      random.uniform(0.01, 0.99)});
  }
  const Evaluation e = surface.evaluate(places, Derivatives::first, true);
  const Curvature curvature = surface.curvature(places);
  std::optional<BruteForce> truth;
  if (brute_force) truth.emplace(surface, 6);
  int searches = 0;
  for (const double height : {0., 1e-4, 0.2}) {
    for (int i = 0; i < kPlaces; ++i) {
      const Vector3 normal = e.normal.row(i);
      if (!normal.allFinite()) continue;
      const double bend = std::max(std::abs(curvature.k1[i]), std::abs(curvature.k2[i]));
      const double distance = std::min(height * diagonal, 0.5 / bend);
      const Points point = e.position.row(i) + distance * normal.transpose();
      ClosestOptions options;
      options.facing = normal.transpose();
      options.max_angle = 1;
      const std::string where = name + ", " + describe(places[i]) + " at " + std::to_string(height);
      const Hits all = search.closest(point), facing = search.closest(point, options);
      ++searches;
      EXPECT_LE(all.distance[0], distance + allowed) << where;
      EXPECT_GE(facing.at[0].face, 0) << where;
      if (facing.at[0].face < 0) continue;
      EXPECT_LE(facing.distance[0], distance + allowed) << where;
      EXPECT_GE(facing.distance[0], all.distance[0] - allowed) << where;
      // The difference is parallel to the normal, unless the place is on the grid's boundary.
      const Vector3 found_normal = facing.normal.row(0);
      const Vector3 offset = (facing.position.row(0) - point).transpose();
      const auto inside = [](double x) { return x > 0.001 && x < 0.999; };
      if (found_normal.allFinite() && inside(facing.at[0].u) && inside(facing.at[0].v)) {
        // But for less than the bound on distances.
        EXPECT_LE(offset.norm() - std::abs(offset.dot(found_normal)), allowed) << where;
        EXPECT_GE(found_normal.dot(normal), std::cos(1.) - 1e-7) << where;
      }
      if (!truth) continue;
      const BruteForce::Foot foot =
          truth->closest(point.row(0).transpose(), [&](const Location& at) {
            const Evaluation here = surface.evaluate({&at, 1}, Derivatives::first, true, 1);
            const Vector3 way = (here.position.row(0) - point).transpose(), n = here.normal.row(0);
            return inside(at.u) && inside(at.v) && n.dot(normal) > std::cos(1.) + 1e-6 &&
                   (way - way.dot(n) * n).norm() <= 1e-12 * diagonal;
          });
      EXPECT_LE(facing.distance[0], static_cast<double>(foot.distance) + allowed) << where;
    }
  }
  return searches;
}

TEST(ClosestSqueezed, PlacesOnNormalsAreFound) {
  Random random(1);
  int searches = 0;
  for (const double factor : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const Squeeze squeeze : {Squeeze::along_y, Squeeze::in_plane, Squeeze::anywhere}) {
      for (const Shape shape : {Shape::flat, Shape::wavy, Shape::rough}) {
        for (const bool triangles : {false, true}) {
          searches += expectPlacesFound(
              squeezedCage(shape, triangles, squeeze, factor, random), factor == 1e-2,
              "factor " + std::to_string(factor) + ", squeeze " +
                  std::to_string(static_cast<int>(squeeze)) + ", shape " +
                  std::to_string(static_cast<int>(shape)) + (triangles ? ", triangles" : ""),
              random);
        }
      }
    }
  }
  EXPECT_GT(searches, 1000);
}

/// All patches that lie along the line beside a point are equally close to it, but for rounding:
/// each is left out as a whole instead of being divided along the curve of its closest places.
TEST(ClosestSqueezed, FewCellsOfALineOfManyFacesAreSearched) {
  constexpr int kCount = 40;
  constexpr int kMostCells[] = {500, 2500};  // of quads and of triangles: twice what they need
  const Vector3 along(0.3, 0.7, 0.11);
  Random random(6);
  Cage quads = fullGrid(15, 15);
  for (int v = 0; v < quads.vertexCount(); ++v) {
    quads.positions.row(v) = random.uniform() * along.transpose();
  }
  for (const bool triangles : {false, true}) {
    const LimitSurface surface = limitSurface(triangles ? inTriangles(quads) : quads);
    for (const double aside : {1e-7, 1e-5, 1e-3}) {
      Points points(kCount, 3);
      Eigen::VectorXd distances(kCount);
      for (int i = 0; i < kCount; ++i) {
        // Within the part of the line that the surface covers for certain.
        const Vector3 away = aside * random.vector(1).cross(along);
        points.row(i) = (random.uniform(0.4, 0.6) * along + away).transpose();
        distances[i] = away.norm();
      }
      std::int64_t cells = 0;
      ClosestOptions options;
      options.cells = &cells;
      const Hits hits = SurfaceSearch(surface).closest(points, options);
      EXPECT_LE((hits.distance - distances).cwiseAbs().maxCoeff(), kSearchError) << aside;
      EXPECT_LE(cells, kMostCells[triangles] * kCount) << aside;
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
