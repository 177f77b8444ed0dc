// SPDX-License-Identifier: Apache-2.0
//
// Closest points with a condition on their normals are local minima of the distance. The distances
// of neighbours tell, whatever the search assumes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "limitsurf/pi.h"
#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// How steeply the distance from a point falls from a location of a face towards places of the same
/// face next to it: the largest difference of distances, divided by that of the places. About 0 or
/// less at a local minimum. `steps` are differences of parameters.
double steepestFall(const LimitSurface& surface, const Vector3& point, const Location& at,
                    const std::vector<double>& steps) {
  constexpr int kDirections = 64;
  double fall = -1;
  for (const double step : steps) {
    std::vector<Location> places{at};
    for (int i = 0; i < kDirections; ++i) {
      const double turn = 2 * kPi<double> * i / kDirections;
      places.push_back({at.face, std::clamp(at.u + step * std::cos(turn), 0., 1.),
                        std::clamp(at.v + step * std::sin(turn), 0., 1.)});
    }
    const Points on = surface.evaluate(places).position;
    const double distance = (on.row(0).transpose() - point).norm();
    const double rounding = 1e-15 * on.cwiseAbs().maxCoeff() + 1e-15 * point.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 1; i < on.rows(); ++i) {
      const double apart = (on.row(i) - on.row(0)).norm();
      if (apart > 0) {
        fall =
            std::max(fall, (distance - (on.row(i).transpose() - point).norm() - rounding) / apart);
      }
    }
  }
  return fall;
}

TEST(Facing, PlacesWithoutANormalAreNoResult) {
  // Both sides of a triangle: they meet in a fold, along which du x dv vanishes.
  Cage cage;
  cage.positions.resize(3, 3);
  cage.positions << 1, 0, -1, -2, 1, 0, 0, -1, 0;
  cage.faces = {{0, 1, 2}, {2, 1, 0}};
  const LimitSurface surface = limitSurface(cage);
  constexpr int kCount = 5000;
  Random random(1);
  Points points(kCount, 3), directions(kCount, 3);
  for (int i = 0; i < kCount; ++i) {
    points.row(i) = random.vector(2).transpose();
    directions.row(i) = random.vector(1).transpose();
  }
  ClosestOptions options;
  options.facing = directions;
  options.max_angle = 1;
  const Hits hits = SurfaceSearch(surface).closest(points, options);
  int found = 0;
  for (int i = 0; i < kCount; ++i) {
    if (hits.at[static_cast<std::size_t>(i)].face < 0) continue;
    ++found;
    const Vector3 normal = hits.normal.row(i), direction = directions.row(i);
    EXPECT_GE(normal.dot(direction), (std::cos(1.) - 1e-9) * direction.norm()) << i;
  }
  EXPECT_GT(found, 0);
}

TEST(Facing, AVertexWhereTheDistanceFallsIsNoResult) {
  // The normals of the vertices face the right way, and no place where the distance has a minimum.
  const LimitSurface surface = limitSurface(cube());
  Points point(1, 3);
  point << 2, 0.5, 0.5;
  ClosestOptions options;
  options.facing = Eigen::RowVector3d(-1, 1, 1);
  options.max_angle = 1;
  EXPECT_EQ(SurfaceSearch(surface).closest(point, options).at[0].face, -1);
}

TEST(Facing, NormalsAtTheTipOfAConeAreThoseOfTheLocations) {
  // Places next to the tip have normals of all directions, and (u, v) near 1 has too few digits to
  // tell them apart.
  Random random(1);
  constexpr int kDirections = 200;
  for (int corner = 0; corner < 4; ++corner) {
    Cage cone;
    cone.positions.resize(7, 3);
    cone.positions << 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 0.5, 0, -1, -1, 0, 0.5, -1, 0;
    cone.faces = {{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 5, 6, 1}};
    for (std::vector<int>& face : cone.faces) {
      std::rotate(face.begin(), face.begin() + corner, face.end());
    }
    cone.options.vertex_sharpness = {{0}, {10}};
    const LimitSurface surface = limitSurface(cone);
    ClosestOptions options;
    options.facing.resize(kDirections, 3);
    for (int i = 0; i < kDirections; ++i) {
      options.facing.row(i) = random.vector(1).transpose();
    }
    options.max_angle = 0.8;
    const Points tips = cone.positions.row(0).replicate(kDirections, 1);
    const Hits hits = SurfaceSearch(surface).closest(tips, options);
    int found = 0;
    for (int i = 0; i < kDirections; ++i) {
      if (hits.at[i].face >= 0) {
        ++found;
        const Vector3 normal = hits.normal.row(i).transpose();
        const double cosine = normal.dot(options.facing.row(i).transpose().normalized());
        EXPECT_GE(cosine, std::cos(options.max_angle + 1e-9)) << corner << ", " << i;
        // as near as (u, v) can be to the tip; it is as near as wanted only at u = v = 0
        EXPECT_LE(hits.distance[i], corner == 0 ? 1e-12 : 3e-9) << corner << ", " << i;
      }
    }
    EXPECT_GT(found, kDirections / 4) << corner;
  }
}

TEST(Facing, PlacesWithoutANormalCountOnlyForAllDirections) {
  // The faces of one row end in one point, where they have no normal; and faces on an oblique line
  // have none anywhere.
  Cage pole = fullGrid(4, 4);
  for (int i = 0; i < 5; ++i) {
    pole.positions.row(i) << 2, 0, 0;
  }
  Cage line = fullGrid(4, 4);
  for (int i = 0; i < line.vertexCount(); ++i) {
    const double along = line.positions(i, 0) + 0.37 * line.positions(i, 1);
    line.positions.row(i) << 0.3 * along, 0.7 * along, 0.11 * along;
  }
  Points points(2, 3);
  points << 2, -1, 0, 0.4, 1, -0.5;
  for (const Cage& cage : {pole, line}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    for (const double max_angle : {0.5, 2., 3.}) {
      ClosestOptions options;
      options.facing = Vector3(0, 0, -1).transpose().replicate(2, 1);
      options.max_angle = max_angle;
      std::int64_t cells = 0;
      options.cells = &cells;
      const Hits hits = search.closest(points, options);
      EXPECT_EQ(hits.at[0].face, -1) << max_angle;
      EXPECT_LT(cells, 20'000) << max_angle;
    }
    ClosestOptions all;
    all.facing = Vector3(0, 0, -1).transpose().replicate(2, 1);
    all.max_angle = kPi<double>;
    const Hits hits = search.closest(points, all), any = search.closest(points);
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(hits.distance[i], any.distance[i]);
    }
  }
}

TEST(Facing, MaximaAndSaddlesAreNoResults) {
  const auto find = [](const LimitSurface& surface, const Vector3& point, const Vector3& facing,
                       double max_angle) {
    ClosestOptions options;
    options.facing = facing.transpose();
    options.max_angle = max_angle;
    return SurfaceSearch(surface).closest(point.transpose(), options);
  };
  // The farthest vertex of a cube. Places next to it have hardly any slope.
  EXPECT_EQ(find(limitSurface(cube()), {2, 2, 2}, {-1, -1, -1}, 0.6).at[0].face, -1);

  // A saddle on a face, above its centre of curvature.
  Cage saddle = fullGrid(4, 4);
  for (int i = 0; i < saddle.vertexCount(); ++i) {
    const double x = saddle.positions(i, 0) - 2, y = saddle.positions(i, 1) - 2;
    saddle.positions.row(i) << x, y, 0.5 * x * y;
  }
  EXPECT_EQ(find(limitSurface(saddle), {0, 0, 5}, {0, 0, 1}, 0.05).at[0].face, -1);

  // A bowl, seen from above its centre of curvature, hides a floor below.
  Cage bowl = fullGrid(5, 5);
  const Cage floor = fullGrid(3, 3);
  for (int i = 0; i < bowl.vertexCount(); ++i) {
    const double x = bowl.positions(i, 0) - 2.5, y = bowl.positions(i, 1) - 2.5;
    bowl.positions.row(i) << x, y, 0.5 * (x * x + y * y);
  }
  const int count = bowl.vertexCount();
  for (const std::vector<int>& face : floor.faces) {
    bowl.faces.push_back(face);
    for (int& vertex : bowl.faces.back()) vertex += count;
  }
  bowl.positions.conservativeResize(count + floor.vertexCount(), 3);
  for (int i = 0; i < floor.vertexCount(); ++i) {
    bowl.positions.row(count + i) << 4 * floor.positions(i, 0) - 6, 4 * floor.positions(i, 1) - 6,
        -6;
  }
  const Hits below = find(limitSurface(bowl), {0, 0, 3}, {0, 0, 1}, 0.05);
  EXPECT_NEAR(below.distance[0], 9, 1e-12);
}

TEST(Facing, ResultsAreLocalMinima) {
  Random random(1);
  constexpr int kPoints = 60;
  int found = 0;
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Eigen::RowVector3d low = surface.positions().colwise().minCoeff(),
                             high = surface.positions().colwise().maxCoeff();
    const Eigen::RowVector3d middle = (low + high) / 2, size = high - low;
    for (const double max_angle : {0.7, kPi<double> / 2}) {
      Points points(kPoints, 3);
      ClosestOptions options;
      options.max_angle = max_angle;
      options.facing.resize(kPoints, 3);
      for (int i = 0; i < kPoints; ++i) {
        const Eigen::RowVector3d away = random.vector(0.8).transpose();
        points.row(i) = middle + away.cwiseProduct(size);
        options.facing.row(i) = random.vector(1).transpose();
      }
      const Hits hits = search.closest(points, options);
      for (int i = 0; i < kPoints; ++i) {
        if (hits.at[i].face >= 0) {
          ++found;
          EXPECT_LE(steepestFall(surface, points.row(i), hits.at[i], {1e-7, 1e-8}), 1e-3)
              << name << ", row " << i << ": " << describe(hits.at[i]);
          // Farther away, maxima and saddles fall, too.
          const double to_sides =
              std::min({hits.at[i].u, 1 - hits.at[i].u, hits.at[i].v, 1 - hits.at[i].v});
          if (to_sides > 1e-3) {
            EXPECT_LE(steepestFall(surface, points.row(i), hits.at[i], {1e-3}), 1e-5)
                << name << ", row " << i << ": " << describe(hits.at[i]);
          }
        }
      }
    }
  }
  EXPECT_GT(found, 1000);
}

/// The corners of all faces at a place.
std::vector<Location> cornersAt(const LimitSurface& surface, const Vector3& place, double margin) {
  std::vector<Location> corners;
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (int corner = 0; corner < 4 && surface.refused().count(surface.baseFace()[face]) == 0;
         ++corner) {
      corners.push_back(cornerLocation(face, corner));
    }
  }
  const Points on = surface.evaluate(corners).position;
  std::vector<Location> found;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((on.row(static_cast<Eigen::Index>(i)).transpose() - place).norm() < margin) {
      found.push_back(corners[i]);
    }
  }
  return found;
}

TEST(Facing, AVertexIsFoundFromPointsOnItsNormal) {
  int checked = 0;
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double diagonal =
        (surface.positions().colwise().maxCoeff() - surface.positions().colwise().minCoeff())
            .norm();
    for (const Location& at : surface.vertexLocations()) {
      if (at.face < 0) {
        continue;
      }
      const Evaluation vertex = surface.evaluate({&at, 1}, Derivatives::first, true);
      if (!vertex.normal.allFinite()) {
        continue;
      }
      const std::vector<Location> corners =
          cornersAt(surface, vertex.position.row(0), 1e-12 * diagonal);
      ClosestOptions options;
      options.facing = vertex.normal;
      options.max_angle = 0.01;
      for (const double height : {-1e-3, 1e-6, 1e-3}) {
        const Points point = vertex.position + height * diagonal * vertex.normal;
        const Hits hits = search.closest(point, options);
        // Towards the hollow side of a vertex where the curvature has no bound, there is no
        // minimum.
        const auto falls = [&](const Location& corner) {
          return steepestFall(surface, point.row(0), corner, {1e-3, 1e-4, 1e-5, 1e-6}) > 1e-8;
        };
        if (std::any_of(corners.begin(), corners.end(), falls)) {
          continue;
        }
        ++checked;
        ASSERT_GE(hits.at[0].face, 0) << name << ", " << describe(at) << ", height " << height;
        EXPECT_LE(hits.distance[0], (std::abs(height) + kSearchError) * diagonal)
            << name << ", " << describe(at) << ", height " << height;
      }
    }
  }
  EXPECT_GT(checked, 1000);
}

}  // namespace
}  // namespace limitsurf::test
