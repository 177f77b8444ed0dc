// SPDX-License-Identifier: Apache-2.0
//
// Closest points and rays at vertices with many faces, compared with the closest of many points,
// and what they cost, counted.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "limitsurf/pi.h"
#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/cages/poles.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

struct Vertex {
  explicit Vertex(const LimitSurface& surface) {
    const Location at{0, 0, 0};
    position = surface.evaluate(std::vector<Location>{at}).position.row(0).transpose();
    const auto frame = surface.frames({&at, 1}, 1);
    normal = Vector3(frame(0, 2), frame(0, 5), frame(0, 8));
  }
  Vector3 position, normal;
};

/// Points of all faces, ever denser towards their first corners.
std::vector<Location> placesAround(const LimitSurface& surface, int levels) {
  std::vector<Location> places;
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (int level = 0; level < levels; ++level) {
      const double size = std::ldexp(1., -level);
      for (int i = 0; i <= 6; ++i) {
        for (int j = 0; j <= 6; ++j) places.push_back({face, size * i / 6, size * j / 6});
      }
    }
  }
  return places;
}

/// The least distance that a descent finds from some of the nearest samples.
double leastDistance(const LimitSurface& surface, const Vector3& point,
                     const std::vector<Location>& places, const Points& samples) {
  constexpr std::size_t kStarts = 4;
  const Eigen::VectorXd distances = (samples.rowwise() - point.transpose()).rowwise().norm();
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::partial_sort(
      order.begin(), order.begin() + kStarts, order.end(), [&](std::size_t a, std::size_t b) {
        return distances[static_cast<Eigen::Index>(a)] < distances[static_cast<Eigen::Index>(b)];
      });
  double least = distances.minCoeff();
  for (std::size_t start = 0; start < kStarts; ++start) {
    Location at = places[order[start]];
    double here = distances[static_cast<Eigen::Index>(order[start])];
    for (double step = 0.25; step > 1e-9;) {
      std::vector<Location> around;
      for (int i = 0; i < 9; ++i) {
        const double size = step * std::max(at.u, at.v);
        around.push_back({at.face, std::clamp(at.u + (i % 3 - 1) * size, 0., 1.),
                          std::clamp(at.v + (i / 3 - 1) * size, 0., 1.)});
      }
      const Points found = surface.evaluate(around).position;
      Eigen::Index best;
      const double next = (found.rowwise() - point.transpose()).rowwise().norm().minCoeff(&best);
      if (next < here) {
        here = next;
        at = around[static_cast<std::size_t>(best)];
      } else {
        step /= 2;
      }
    }
    least = std::min(least, here);
  }
  return least;
}

/// Closest points near the axis, from both sides, at all scales, and with a turned and moved cage.
TEST(ClosestAtPoles, NoPointOfTheSurfaceIsCloser) {
  int compared = 0;
  for (auto [name, cage] : poles()) {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
    cage.positions =
        ((cage.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 1, -2)).eval();
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Vertex vertex(surface);
    const std::vector<Location> places = placesAround(surface, 12);
    const Points samples = surface.evaluate(places).position;
    Random random(6);
    std::vector<Vector3> points;
    for (const double height : {1e-9, 1e-4, 0.03, 0.2, 0.5, 2., 100.}) {
      for (const double aside : {0., 1e-15, 1e-13, 1e-9, 1e-4, 0.03}) {
        for (const double side : {-1., 1.}) {
          points.push_back(vertex.position + side * height * vertex.normal +
                           aside * random.vector(1).normalized());
        }
      }
    }
    Points rows(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    }
    const Hits hits = search.closest(rows);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const double nearest = leastDistance(surface, rows.row(i).transpose(), places, samples);
      EXPECT_LE(hits.distance[i], nearest + 2e-12) << name << " " << i;
      EXPECT_NEAR((hits.position.row(i) - rows.row(i)).norm(), hits.distance[i], 1e-13) << name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 700);
}

/// On a flat pole the bounds of whole rings are as large as the distances that they stand for, up
/// to rounding.
TEST(ClosestAtPoles, PointsOfFlatPolesAreFoundAtNoDistance) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  for (const int faces : {8, 20, 40}) {
    Cage cage = flattened(pole(faces));
    cage.positions = (cage.positions * turn.transpose()).eval();
    const double diagonal =
        (cage.positions.colwise().maxCoeff() - cage.positions.colwise().minCoeff()).norm();
    const LimitSurface surface = limitSurface(cage);
    Random random(12);
    std::vector<Location> places;
    for (int i = 0; i < 2000; ++i) {
      const double size = std::ldexp(1., -(i % 40));
      places.push_back({i % faces, size * random.uniform(0, 1), size * random.uniform(0, 1)});
    }
    const Points points = surface.evaluate(places).position;
    ClosestOptions options;
    options.max_distance = kSearchError * diagonal;
    const Hits hits = SurfaceSearch(surface).closest(points, options);
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_GE(hits.at[i].face, 0) << faces << " " << i;
      EXPECT_LE(hits.distance[static_cast<Eigen::Index>(i)], 0.21 * kSearchError * diagonal)
          << faces << " " << i;
    }
  }
}

/// Next to a vertex with many faces the surface moves far with the last digit of a parameter,
/// unless the vertex is at (0, 0) of its faces. Results there are as close as the digits of u and v
/// allow.
TEST(ClosestAtPoles, ResultsAreAsCloseAsTheDigitsOfLocations) {
  const Cage cage = fan(30, true, 4);
  Cage turned = cage;
  for (std::vector<int>& face : turned.faces)
    std::rotate(face.begin(), face.begin() + 2, face.end());
  const LimitSurface surface = limitSurface(cage), other = limitSurface(turned);
  const double diagonal = test::diagonal(cage.positions);
  // How far apart the places next to the vertex are.
  std::vector<Location> next = {{0, 1, 1}};
  for (int i = 1; i < 4; ++i) next.push_back({0, 1 - (i & 1) * 0x1p-53, 1 - (i >> 1) * 0x1p-53});
  const Points steps = other.evaluate(next).position;
  const double apart = (steps.rowwise() - steps.row(0)).rowwise().norm().maxCoeff();
  EXPECT_GT(apart, 1e-12 * diagonal);
  EXPECT_LT(apart, 1e-9 * diagonal);

  Random random(13);
  std::vector<Location> places;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::ldexp(1., -20 - i % 40);
    places.push_back({4 * (i % 30), size * random.uniform(), size * random.uniform()});
  }
  Points points = surface.evaluate(places).position;
  for (const double height : {1e-12, 1e-10, 1e-9, 1e-8, 1e-3}) {
    const double distance = height * diagonal;
    Points from = points;
    for (Eigen::Index i = 0; i < from.rows(); ++i) {
      from.row(i) += distance * random.vector(1).normalized().transpose();
    }
    const Hits fine = SurfaceSearch(surface).closest(from),
               coarse = SurfaceSearch(other).closest(from);
    for (Eigen::Index i = 0; i < from.rows(); ++i) {
      const double allowed =
          std::min(apart, 0.5 * apart * apart / fine.distance[i]) + 0.25 * kSearchError * diagonal;
      EXPECT_LE(fine.distance[i], distance + 0.25 * kSearchError * diagonal) << height << " " << i;
      EXPECT_LE(coarse.distance[i], fine.distance[i] + allowed) << height << " " << i;
      EXPECT_GE(coarse.distance[i], fine.distance[i] - 0.25 * kSearchError * diagonal)
          << height << " " << i;
    }
  }
}

/// What searches know of a vertex is made when it is first asked for. It must not change what later
/// ones find.
TEST(ClosestAtPoles, ResultsDoNotDependOnEarlierSearches) {
  Random random(11);
  for (const int faces : {3, 5, 20}) {
    const LimitSurface surface = limitSurface(perturbed(pole(faces), 0.02, 5));
    const Vertex vertex(surface);
    constexpr int kCount = 300;
    Points points(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      const double size = std::pow(10., random.uniform(-14, 0));
      points.row(i) = (vertex.position + random.vector(size)).transpose();
    }
    const SurfaceSearch search(surface);
    search.closest(points);
    const Hits later = search.closest(points);
    for (int i = 0; i < kCount; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const Hits first = SurfaceSearch(surface).closest(points.row(i));
      EXPECT_EQ(first.at[0].face, later.at[row].face) << faces << " " << i;
      EXPECT_EQ(first.at[0].u, later.at[row].u) << faces << " " << i;
      EXPECT_EQ(first.at[0].v, later.at[row].v) << faces << " " << i;
    }
  }
}

/// At a regular polygon any of the equally near faces may be given; a condition on normals, or a
/// point off the axis, tells them apart.
TEST(ClosestAtPoles, DirectionsTellTheFacesOfARegularPoleApart) {
  const LimitSurface surface = limitSurface(pole(24));
  const SurfaceSearch search(surface);
  const Vertex vertex(surface);
  constexpr int kCount = 24;
  Points points(kCount, 3);
  ClosestOptions options;
  options.facing.resize(kCount, 3);
  options.max_angle = 1.3;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * kPi<double> * i / kCount;
    points.row(i) << vertex.position[0], vertex.position[1], vertex.position[2] - 0.3;
    options.facing.row(i) << std::cos(angle), std::sin(angle), 0;
  }
  const Hits all = search.closest(points), facing = search.closest(points, options);
  for (int i = 0; i < kCount; ++i) {
    ASSERT_GE(facing.at[static_cast<std::size_t>(i)].face, 0);
    EXPECT_NEAR(facing.distance[i], all.distance[i], 1e-12);
    EXPECT_GT(facing.normal.row(i).dot(options.facing.row(i)), std::cos(1.3) - 1e-9);
  }
}

double meanLeaves(const Cage& cage, double height, double aside) {
  constexpr int kCount = 20;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  const Vertex vertex(surface);
  Random random(7);
  Points points(kCount, 3);
  for (int i = 0; i < kCount; ++i) {
    points.row(i) = (vertex.position + height * vertex.normal + random.vector(aside)).transpose();
  }
  std::int64_t leaves = 0;
  ClosestOptions options;
  options.leaves = &leaves;
  search.closest(points, options);
  return static_cast<double>(leaves) / kCount;
}

TEST(ClosestAtPoles, CostHardlyGrowsWithTheNumberOfFaces) {
  for (const int faces : {20, 100, 1000}) {
    // On the axis before the tip, and behind it, where all faces are equally near.
    EXPECT_LE(meanLeaves(pole(faces), 10, 0), 80) << faces;
    EXPECT_LE(meanLeaves(pole(faces), 0.1, 0), 80) << faces;
    EXPECT_LE(meanLeaves(pole(faces), -0.1, 0), 80) << faces;
    EXPECT_LE(meanLeaves(flattened(pole(faces)), 0.1, 0), 10) << faces;
    EXPECT_LE(meanLeaves(perturbed(pole(faces), 1e-3 / faces, 8), 0.1, 0), 80) << faces;
    // Near the axis.
    EXPECT_LE(meanLeaves(pole(faces), 0.1, 1e-3), 80) << faces;
    EXPECT_LE(meanLeaves(pole(faces), 0, 1e-4), 100) << faces;
    EXPECT_LE(meanLeaves(flattened(pole(faces)), 0.1, 1e-3), 40) << faces;
  }
  EXPECT_LE(meanLeaves(pole(6), 0.1, 0), 40);
}

/// The faces of a pole are slivers whose boxes contain many points of other faces, so that the
/// boxes do not tell which face is nearest: searches walked from face to face, around the pole, and
/// visited 56 of 4,000 triangles' patches, in 660 cells.
TEST(ClosestAtPoles, FewSliversAreSearchedForAPointBesideThem) {
  for (const int faces : {100, 1000, 4000}) {
    constexpr int kCount = 200;
    const LimitSurface surface = limitSurface(pole(faces));
    Random random(8);
    std::vector<Location> places;
    for (int i = 0; i < kCount; ++i) {
      places.push_back({random.below(surface.faceCount()), random.uniform(), random.uniform()});
    }
    Points points = surface.evaluate(places).position;
    for (int i = 0; i < kCount; ++i) {
      points.row(i) += random.vector(0.1).transpose();
    }
    std::int64_t leaves = 0, cells = 0;
    ClosestOptions options;
    options.leaves = &leaves;
    options.cells = &cells;
    SurfaceSearch(surface).closest(points, options);
    EXPECT_LE(leaves, 24 * kCount) << faces;
    EXPECT_LE(cells, 130 * kCount) << faces;
  }
}

TEST(RayCastAtPoles, RaysThroughTheVertexHitIt) {
  int hits = 0;
  for (const auto& [name, cage] : poles()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Vertex vertex(surface);
    Random random(9);
    constexpr int kCount = 60;
    Points origins(kCount, 3), directions(kCount, 3);
    for (int i = 0; i < kCount; ++i) {
      const double side = i % 2 == 0 ? 1 : -1, slant = i < 20 ? 0 : 0.1 * (i / 2 % 10);
      const Vector3 away =
          (side * vertex.normal + slant * random.vector(1).normalized()).normalized();
      origins.row(i) = (vertex.position + random.uniform(0.01, 30) * away).transpose();
      directions.row(i) = vertex.position.transpose() - origins.row(i);
      if (i % 3 == 0) origins.row(i) += random.vector(std::pow(10., -i / 4.)).transpose();
    }
    const Hits first = search.rayCast(origins, directions);
    const RayHits all = search.rayCastAll(origins, directions);
    for (int i = 0; i < kCount; ++i) {
      if (i % 3 != 0) {
        ASSERT_GE(first.at[static_cast<std::size_t>(i)].face, 0) << name << " " << i;
        EXPECT_LE(first.distance[i], directions.row(i).norm() + 3e-12) << name << " " << i;
      }
      if (first.at[static_cast<std::size_t>(i)].face < 0) continue;
      const Vector3 d = directions.row(i).normalized().transpose();
      const Vector3 at = first.position.row(i).transpose() - origins.row(i).transpose();
      EXPECT_LE(at.cross(d).norm(), 3e-12) << name << " " << i;
      ASSERT_LT(all.offsets[static_cast<std::size_t>(i)],
                all.offsets[static_cast<std::size_t>(i) + 1]);
      EXPECT_NEAR(all.distance[all.offsets[static_cast<std::size_t>(i)]], first.distance[i], 3e-12)
          << name << " " << i;
      ++hits;
    }
  }
  EXPECT_GT(hits, 400);
}

}  // namespace
}  // namespace limitsurf::test
