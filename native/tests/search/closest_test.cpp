// SPDX-License-Identifier: Apache-2.0
//
// Closest points, compared with dense samples and their local refinement, with subdivision in 50
// digits and with OpenSubdiv's points of the surface.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <optional>

#include "limitsurf/pi.h"
#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/throws.h"
#include "support/truth/brute_force.h"
#include "support/truth/corner_points.h"
#include "support/truth/far_limit.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Points rowsOf(const std::vector<Vector3>& rows) {
  Points points(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = rows[i];
  return points;
}

std::string textOf(const Vector3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "point (%.17g, %.17g, %.17g)", p[0], p[1], p[2]);
  return text;
}

struct Middle {
  explicit Middle(const LimitSurface& surface) {
    const Eigen::RowVector3d low = surface.positions().colwise().minCoeff(),
                             high = surface.positions().colwise().maxCoeff();
    at = ((low + high) / 2).transpose();
    diagonal = (high - low).norm();
    half = ((high - low) / 2).transpose();
  }
  Vector3 at, half;
  double diagonal;
};

Vector3 direction(Random& random) {
  for (;;) {
    const Vector3 v = random.vector(1);
    if (v.norm() < 1 && v.norm() > 0.01) return v.normalized();
  }
}

/// `count` points of each kind: near the surface, around it, in its middle, and far away.
Points pointsAround(const LimitSurface& surface, int count, Random& random) {
  const Middle middle(surface);
  std::vector<Vector3> rows;
  for (const double distance : {1e-6, 1e-3, 0.05}) {
    const Points on = surface.evaluate(searchedLocations(surface, count, random)).position;
    for (int i = 0; i < count; ++i) {
      rows.push_back(Vector3(on.row(i)) + distance * middle.diagonal * direction(random));
    }
  }
  for (int i = 0; i < count; ++i) {
    const Vector3 part = random.vector(1);
    rows.push_back(middle.at + part.cwiseProduct(middle.half));
    rows.push_back(middle.at + 1e-3 * middle.diagonal * part);
    rows.push_back(middle.at + 10 * middle.diagonal * direction(random));
    rows.push_back(middle.at + 1000 * middle.diagonal * direction(random));
  }
  rows.push_back(middle.at);
  return rowsOf(rows);
}

/// Expects that a result is a point of the surface, at the distance that it states.
void expectConsistent(const std::string& name, const LimitSurface& surface, const Points& points,
                      const Hits& hits) {
  ASSERT_EQ(static_cast<Eigen::Index>(hits.at.size()), points.rows());
  std::vector<Location> found;
  for (const Location& at : hits.at) {
    if (at.face >= 0) found.push_back(at);
  }
  const Evaluation e = surface.evaluate(found, Derivatives::first, true);
  int next = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const std::string where = name + ", " + textOf(points.row(i));
    if (hits.at[i].face < 0) {
      EXPECT_TRUE(std::isnan(hits.at[i].u) && std::isnan(hits.at[i].v)) << where;
      EXPECT_TRUE(std::isnan(hits.distance[i])) << where;
      EXPECT_TRUE(hits.position.row(i).array().isNaN().all()) << where;
      EXPECT_TRUE(hits.normal.row(i).array().isNaN().all()) << where;
      continue;
    }
    EXPECT_TRUE(hits.position.row(i) == e.position.row(next)) << where;
    EXPECT_TRUE(hits.normal.row(i) == e.normal.row(next) ||
                (hits.normal.row(i).hasNaN() && e.normal.row(next).hasNaN()))
        << where;
    const double distance =
        static_cast<double>(distanceBetween(e.position.row(next), points.row(i)));
    EXPECT_LE(std::abs(hits.distance[i] - distance), 1e-15 * distance) << where;
    ++next;
  }
}

/// Compares the search with brute force at all points. Returns the largest excess / diagonal.
double compareWithBruteForce(const std::string& name, const BruteForce& truth,
                             const SurfaceSearch& search, const Points& points) {
  const Hits hits = search.closest(points);
  expectConsistent(name, truth.surface(), points, hits);
  double worst = -kInfinity;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vector3 point = points.row(i);
    const BruteForce::Foot foot = truth.closest(point);
    const double excess =
        static_cast<double>(hits.distance[i] - foot.distance) / std::max(truth.diagonal(), 1e-300);
    EXPECT_LE(excess, kSearchError)
        << name << ", " << textOf(point) << ": found " << describe(hits.at[i]) << " at "
        << hits.distance[i] << ", but " << describe(foot.at) << " is nearer by " << excess
        << " diagonals";
    worst = std::max(worst, excess);
  }
  return worst;
}

void compareAll(const NamedCages& cages, int count, int per_side) {
  Random random(1);
  double worst = -kInfinity;
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const BruteForce truth(surface, per_side);
    const Points points = pointsAround(surface, count, random);
    worst = std::max(worst, compareWithBruteForce(name, truth, search, points));
  }
  std::printf("worst excess over brute force: %.2g diagonals\n", worst);
}

TEST(Closest, IsNearerThanWhatBruteForceFinds) { compareAll(queryCages(), 4, 12); }

TEST(Closest, OfAPointOfTheSurfaceIsThatPoint) {
  Random random(2);
  double worst = 0;
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    std::vector<Location> at = searchedLocations(surface, 400, random);
    for (const Location& vertex : surface.vertexLocations()) {
      if (vertex.face >= 0) at.push_back(vertex);
    }
    const Points points = surface.evaluate(at).position;
    const Hits hits = search.closest(points);
    const double allowed = kSearchError * Middle(surface).diagonal;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double distance = hits.distance[static_cast<Eigen::Index>(i)];
      EXPECT_LE(distance, allowed) << name << ", " << describe(at[i]);
      worst = std::max(worst, distance / allowed);
    }
  }
  std::printf("worst distance of points of the surface: %.2g of what is allowed\n", worst);
}

TEST(Closest, IsNearerThanOpenSubdivsPoints) {
  // The library has no part in these points of the surface: none of them may be nearer than the
  // result, and the nearest of them cannot be farther away than a step between them.
  Random random(3);
  for (const auto& [name, cage] : NamedCages{{"cross", cross()},
                                             {"cube", perturbed(cube(), 0.2, 1)},
                                             {"torus", torus(6, 5)},
                                             {"tetrahedron", tetrahedron()},
                                             {"mixture", mixture(3)},
                                             {"holes", gridWithHoles(6, 5, {7, 9, 17, 22})},
                                             {"fan", fan(9, false, 16)}}) {
    const LimitSurface surface = limitSurface(cage);
    const FarLimit far = farLimit(cage, 5);
    const Points points = pointsAround(surface, 10, random);
    const Hits hits = SurfaceSearch(surface).closest(points);
    const double diagonal = Middle(surface).diagonal;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      Eigen::Index nearest;
      (far.position.rowwise() - points.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
      const DoubleDouble distance = distanceBetween(far.position.row(nearest), points.row(i));
      EXPECT_LE(hits.distance[i], distance + kSearchError * diagonal)
          << name << ", " << textOf(points.row(i));
      EXPECT_GE(hits.distance[i], distance - 0.05 * diagonal)
          << name << ", " << textOf(points.row(i));
    }
  }
}

TEST(Closest, IsOnTheSurfaceOfSubdivisionIn50Digits) {
  // Points of that surface are found at distance 0. Points found elsewhere are at the stated
  // distance, and none of their neighbours is nearer.
  Random random(4);
  NamedCages cages;
  for (const auto& [name, cage] : queryCages()) {
    if (cage.options.scheme == Scheme::catmark && cage.options.holes.empty() &&
        name != "refused face" && name != "valence 100") {
      cages.emplace_back(name, cage);
    }
  }
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    DeepSubdivision deep(cage);
    const auto isIrregularCorner = [corners = CornerPoints(cage)](const Location& at) {
      const CornerPoint* corner = corners.at(at);
      return corner != nullptr && !corner->regular();
    };
    const auto position = [&](const Location& at) {
      return isIrregularCorner(at) ? deep.cornerPosition(at.face, cornerAt(at))
                                   : deep.evaluate(at)[kPosition];
    };
    const double allowed = kSearchError * Middle(surface).diagonal;
    std::vector<Location> at = searchedLocations(surface, 5, random);
    for (const Location& location : at) {
      const Points point = position(location).transpose();
      EXPECT_LE(search.closest(point).distance[0], allowed) << name << ", " << describe(location);
    }
    const Points points = pointsAround(surface, 1, random);
    const Hits hits = search.closest(points);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Vector3 point = points.row(i);
      const std::string where = name + ", " + textOf(point);
      const Location& found = hits.at[static_cast<std::size_t>(i)];
      const DoubleDouble distance = distanceBetween(position(found), point);
      EXPECT_LE(std::abs(static_cast<double>(distance - hits.distance[i])), allowed) << where;
      for (const double step : {1e-2, 1e-4, 1e-6}) {
        for (int turn = 0; turn < 4; ++turn) {
          const Location near = {found.face,
                                 std::clamp(found.u + (turn % 2 ? step : -step), 0., 1.),
                                 std::clamp(found.v + (turn / 2 ? step : -step), 0., 1.)};
          EXPECT_GE(distanceBetween(position(near), point), distance - allowed) << where;
        }
      }
    }
  }
}

TEST(Closest, OfDegenerateCagesAndAtAnyScale) {
  compareAll(degenerateCages(), 4, 12);
  NamedCages cages;
  for (const double factor : {1e-30, 1e30}) {
    cages.emplace_back("cube times " + std::to_string(factor),
                       placed(perturbed(cube(), 0.2, 1), factor));
    cages.emplace_back("mixture times " + std::to_string(factor), placed(mixture(3), factor));
    cages.emplace_back("fan times " + std::to_string(factor), placed(fan(9, false, 16), factor));
  }
  compareAll(cages, 4, 12);
}

TEST(Closest, FarFromTheOriginIsAsExactAsCoordinatesAllow) {
  Random random(5);
  for (const auto& [name, cage] :
       {std::pair("cube", perturbed(cube(), 0.2, 1)), std::pair("mixture", mixture(3)),
        std::pair("fan", fan(9, false, 16))}) {
    const Vector3 offset = 1e6 * Vector3(1, -2, 0.5);
    const Cage moved = placed(cage, 1, offset);
    const LimitSurface surface = limitSurface(moved);
    const SurfaceSearch search(surface);
    const BruteForce truth(surface, 12);
    const Points points = pointsAround(surface, 20, random);
    const Hits hits = search.closest(points);
    expectConsistent(name, surface, points, hits);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double excess =
          static_cast<double>(hits.distance[i] - truth.closest(points.row(i)).distance);
      EXPECT_LE(excess, kSearchError * truth.diagonal() + 0x1p-52 * offset.norm())
          << name << ", " << textOf(points.row(i));
    }
  }
}

TEST(Closest, KeepsToTheGreatestDistance) {
  Random random(6);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double diagonal = Middle(surface).diagonal;
    const Points points = pointsAround(surface, 2, random);
    const Hits all = search.closest(points);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const std::string where = name + ", " + textOf(points.row(i));
      ClosestOptions options;
      const double slack = 4 * kSearchError * diagonal + 1e-14 * all.distance[i];
      options.max_distance = all.distance[i] + slack;
      const Hits within = search.closest(points.row(i), options);
      EXPECT_GE(within.at[0].face, 0) << where;
      EXPECT_LE(within.distance[0], options.max_distance) << where;
      EXPECT_LE(within.distance[0], all.distance[i] + slack) << where;
      options.max_distance = all.distance[i];
      EXPECT_GE(search.closest(points.row(i), options).at[0].face, 0) << where << " at it";
      if (all.distance[i] > 2 * slack) {
        options.max_distance = all.distance[i] - slack;
        EXPECT_EQ(search.closest(points.row(i), options).at[0].face, -1) << where;
      }
    }
    ClosestOptions none;
    none.max_distance = 0;
    const Points on = surface.evaluate(searchedLocations(surface, 3, random)).position;
    const Hits hits = search.closest(on, none);
    for (Eigen::Index i = 0; i < on.rows(); ++i) {
      EXPECT_TRUE(hits.at[i].face < 0 || hits.distance[i] <= kSearchError * diagonal) << name;
    }
  }
}

/// Compares at one in `step` of the points around one in `cage_step` of the cages. The truth are
/// minima inside faces and on borders, where no neighbouring face matters. Returns how many results
/// are farther away than without a direction.
int compareFacing(int per_side, int step, std::size_t cage_step) {
  Random random(7);
  int elsewhere = 0;
  const NamedCages cages = queryCages();
  for (std::size_t number = cage_step / 2; number < cages.size(); number += cage_step) {
    const auto& [name, cage] = cages[number];
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const BruteForce truth(surface, per_side);
    std::optional<CornerPoints> corners;
    if (cage.options.scheme == Scheme::catmark && name != "refused face") corners.emplace(cage);
    const Points around = pointsAround(surface, 3, random);
    std::vector<Vector3> rows;
    for (Eigen::Index i = step / 2; i < around.rows(); i += step) rows.push_back(around.row(i));
    const Points points = rowsOf(rows);
    ClosestOptions options;
    options.facing.resize(points.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      options.facing.row(i) = random.uniform(0.1, 10) * direction(random);
    }
    options.max_angle = random.uniform(0.5, 2.5);
    const Hits all = search.closest(points), hits = search.closest(points, options);
    expectConsistent(name, surface, points, hits);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Vector3 point = points.row(i), facing = options.facing.row(i).normalized();
      const std::string where = name + ", " + textOf(point);
      const auto accepts = [&](const Location& at) {
        const Vector3 normal =
            surface.evaluate({&at, 1}, Derivatives::first, true, 1).normal.row(0);
        const auto inside = [](double x) { return x > 1e-6 && x < 1 - 1e-6; };
        return ((inside(at.u) && inside(at.v)) ||
                ((inside(at.u) || inside(at.v)) && corners && isOnBorder(*corners, at))) &&
               angle(normal, facing) < options.max_angle - 1e-6;
      };
      const BruteForce::Foot foot = truth.closest(point, accepts);
      const Location& found = hits.at[static_cast<std::size_t>(i)];
      if (found.face < 0) {
        EXPECT_EQ(foot.at.face, -1) << where << ": " << describe(foot.at) << " was not found";
        continue;
      }
      elsewhere += hits.distance[i] > all.distance[i] + 1e-9 * truth.diagonal();
      EXPECT_LE(hits.distance[i],
                static_cast<double>(foot.distance) + kSearchError * truth.diagonal())
          << where << ": " << describe(found) << " but " << describe(foot.at);
      if (hits.normal.row(i).allFinite()) {
        EXPECT_LE(angle(hits.normal.row(i), facing), options.max_angle + 1e-9)
            << where << ": " << describe(found);
      }
    }
  }
  return elsewhere;
}

TEST(Closest, FacingLeavesOutFeetThatLookElsewhere) { EXPECT_GT(compareFacing(8, 7, 5), 2); }

TEST(SlowClosest, FacingLeavesOutFeetThatLookElsewhere) { EXPECT_GT(compareFacing(16, 1, 1), 200); }

TEST(Closest, FacingTakesTheSideOfASheetThatIsAskedFor) {
  // Two parallel squares; the normal of the lower one points down.
  Cage cage = grid(3, 3);
  const Cage lower = reversed(placed(cage, 1, {0, 0, -1}));
  for (const std::vector<int>& face : lower.faces) {
    cage.faces.push_back(face);
    for (int& vertex : cage.faces.back()) vertex += cage.vertexCount();
  }
  const int upper_vertices = cage.vertexCount();
  cage.positions.conservativeResize(2 * upper_vertices, 3);
  cage.positions.bottomRows(upper_vertices) = lower.positions;
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  Points point(1, 3);
  point << 1.4, 1.6, -0.1;
  ClosestOptions options;
  EXPECT_NEAR(search.closest(point).distance[0], 0.1, 1e-12);
  options.facing = Eigen::RowVector3d(0.3, 0.1, -2);
  EXPECT_NEAR(search.closest(point, options).distance[0], 0.9, 1e-12);
  options.facing = Eigen::RowVector3d(1e-200, 0, 1e-200);
  EXPECT_NEAR(search.closest(point, options).distance[0], 0.1, 1e-12);
  options.facing = Eigen::RowVector3d(1e200, 0, 0);
  options.max_angle = 1.5;
  EXPECT_EQ(search.closest(point, options).at[0].face, -1);
  options.max_angle = kPi<double>;
  EXPECT_NEAR(search.closest(point, options).distance[0], 0.1, 1e-12);
}

/// Where nothing faces the right way, cones around normals tell so without a look at every patch.
TEST(Closest, FacingCostsLittleWhereNothingFaces) {
  const Cage quads = fullGrid(60, 60);
  Cage bumpy = quads;
  for (int vertex = 0; vertex < bumpy.vertexCount(); ++vertex) {
    bumpy.positions(vertex, 2) = 2 * std::sin(bumpy.positions(vertex, 0) / 5);
  }
  for (const Cage& cage : {quads, bumpy, inTriangles(fullGrid(12, 12))}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const int count = 20;
    Points points(count, 3);
    for (int row = 0; row < count; ++row) {
      points.row(row) = Vector3(0.17 * row + 1, 0.13 * row + 2, 0.5 + 0.01 * row);
    }
    std::int64_t nearest = 0, match = 0, none = 0;
    ClosestOptions options;
    options.leaves = &nearest;
    search.closest(points, options);
    options.leaves = &match;
    options.facing = Vector3(0, 0, 1).transpose().replicate(count, 1);
    const Hits found = search.closest(points, options);
    options.leaves = &none;
    options.facing = -options.facing;
    const Hits missed = search.closest(points, options);
    for (int row = 0; row < count; ++row) {
      EXPECT_GE(found.at[row].face, 0);
      EXPECT_EQ(missed.at[row].face, -1);
    }
    // Where the nearest places face the right way, they are all that is looked for. Else 8 leaves
    // are met by a search without cones, and then none, not even at the corners of the grid.
    EXPECT_EQ(match, nearest);
    EXPECT_LE(none, nearest + 8 * count);
  }
}

/// Cones around normals leave nothing out: a condition that many patches fail is met far away.
TEST(Closest, FacingFindsTheOnlyPlaceThatFaces) {
  // A floor that turns up into a wall.
  Cage cage = fullGrid(40, 40);
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    const double x = cage.positions(vertex, 0);
    cage.positions(vertex, 0) = std::min(x, 35.);
    cage.positions(vertex, 2) = 2 * std::max(0., x - 35);
  }
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  Points points(2, 3);
  points << 2, 20.3, 4, 3, 11.2, 5;
  ClosestOptions options;
  std::int64_t leaves = 0;
  options.leaves = &leaves;
  options.facing = Vector3(-1, 0, 0).transpose().replicate(2, 1);
  options.max_angle = 0.5;
  const Hits hits = search.closest(points, options);
  for (int row = 0; row < 2; ++row) {
    ASSERT_GE(hits.at[row].face, 0);
    EXPECT_LE(
        (hits.position.row(row) - Eigen::RowVector3d(35, points(row, 1), points(row, 2))).norm(),
        1e-9);
  }
  EXPECT_LE(leaves, 2 * (8 + 60));
}

/// The way to a place that faces the right way is along its normal, so that few patches matter even
/// where most have normals within the angle somewhere.
TEST(Closest, FacingLooksAlongTheDirection) {
  const LimitSurface surface = limitSurface(perturbed(torus(32, 16), 0.03, 1));
  const SurfaceSearch search(surface);
  const BruteForce truth(surface, 4);
  const int count = 8;
  std::vector<Location> places;
  for (int row = 0; row < count; ++row) {
    places.push_back({61 * row, 0.1 + 0.1 * row, 0.3});
  }
  const Points on = surface.evaluate(places).position;
  const Vector3 direction = Vector3(0.3, -0.2, 1).normalized();
  ClosestOptions options;
  options.facing = direction.transpose().replicate(count, 1);
  for (const double largest_angle : {0.1, 0.4}) {
    std::int64_t leaves = 0;
    options.max_angle = largest_angle;
    options.leaves = &leaves;
    const Hits hits = search.closest(on, options);
    EXPECT_LE(leaves, 64 * count);  // of more than 512
    for (int row = 0; row < count; ++row) {
      const auto accepts = [&](const Location& at) {
        const Vector3 normal =
            surface.evaluate({&at, 1}, Derivatives::first, true, 1).normal.row(0);
        return std::min({at.u, at.v, 1 - at.u, 1 - at.v}) > 1e-6 &&
               angle(normal, direction) < largest_angle - 1e-6;
      };
      const BruteForce::Foot foot = truth.closest(on.row(row), accepts);
      if (foot.at.face >= 0) {
        ASSERT_GE(hits.at[row].face, 0);
        EXPECT_LE(hits.distance[row],
                  static_cast<double>(foot.distance) + kSearchError * truth.diagonal());
      }
    }
  }
}

TEST(Closest, FacingMayHaveAnyLength) {
  const LimitSurface surface = limitSurface(cube());
  const SurfaceSearch search(surface);
  Points points(1, 3);
  points << 1.5, 0.4, 0.3;
  ClosestOptions options;
  options.facing = Vector3(1, 1, 1).transpose();
  const Hits unit = search.closest(points, options);
  ASSERT_GE(unit.at[0].face, 0);
  for (const double length : {1e-320, 1e-200, 1e200, 1.7e308}) {
    options.facing = length * Vector3(1, 1, 1).transpose();
    const Hits hits = search.closest(points, options);
    EXPECT_EQ(hits.at[0].face, unit.at[0].face) << length;
    EXPECT_EQ(hits.distance[0], unit.distance[0]) << length;
  }
}

TEST(Closest, BitsDependNeitherOnThreadsNorOnTheBatch) {
  Random random(8);
  for (const Cage& cage : {perturbed(cube(), 0.2, 1), mixture(3), pole(100)}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface), again(surface, 1);
    const Points points = pointsAround(surface, 60, random);
    const Hits all = search.closest(points);
    for (const Hits& other :
         {search.closest(points, {}, 1), search.closest(points, {}, 3), again.closest(points)}) {
      EXPECT_TRUE(other.position == all.position && other.distance == all.distance);
      for (std::size_t i = 0; i < all.at.size(); ++i) {
        EXPECT_TRUE(other.at[i].face == all.at[i].face && other.at[i].u == all.at[i].u &&
                    other.at[i].v == all.at[i].v);
      }
    }
    for (Eigen::Index i = points.rows() - 1; i >= 0; i -= 7) {
      const Hits one = search.closest(points.row(i));
      EXPECT_TRUE(one.position.row(0) == all.position.row(i) &&
                  one.distance[0] == all.distance[i] && one.at[0].face == all.at[i].face &&
                  one.at[0].u == all.at[i].u && one.at[0].v == all.at[i].v);
    }
  }
}

/// Searches make use of what the one before has found. Where several places are equally close that
/// must not decide which of them is taken.
TEST(Closest, BitsDoNotDependOnTheBatchWhereSeveralPlacesAreClosest) {
  Cage sheets = fullGrid(4, 4);
  const int count = sheets.vertexCount();
  sheets.positions.conservativeResize(2 * count, 3);
  sheets.positions.bottomRows(count) = sheets.positions.topRows(count);
  const std::vector<std::vector<int>> faces = sheets.faces;
  for (std::vector<int> face : faces) {
    for (int& vertex : face) vertex += count;
    sheets.faces.push_back(face);
  }
  Random random(11);
  for (const Cage& cage : {cube(), fullGrid(4, 4), sheets, inTriangles(cube())}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const Middle middle(surface);
    // On planes of symmetry, and close together, so that the last place is a good bound.
    Points points(400, 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        points(i, axis) = middle.at[axis] + 0.125 * (random.below(9) - 4) * middle.diagonal;
      }
    }
    const Hits all = search.closest(points, {}, 1);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Hits one = search.closest(points.row(i));
      const Location &alone = one.at[0], &together = all.at[static_cast<std::size_t>(i)];
      EXPECT_TRUE(alone.face == together.face && alone.u == together.u && alone.v == together.v &&
                  one.distance[0] == all.distance[i])
          << textOf(points.row(i).transpose());
    }
  }
}

TEST(Closest, TellsWhatIsWrongWithItsArguments) {
  const LimitSurface surface = limitSurface(cube());
  const SurfaceSearch search(surface);
  Points points = Points::Zero(3, 3);
  points(2, 1) = NAN;
  const auto closest = [&](const ClosestOptions& options = {}, int threads = 0) {
    return [&, options, threads] { search.closest(points, options, threads); };
  };
  using Error = std::invalid_argument;
  expectThrow<Error>(closest(), {"row 2", "point", "finite"});
  points(2, 1) = kInfinity;
  expectThrow<Error>(closest(), {"row 2", "point", "inf"});
  points(2, 1) = 0;
  ClosestOptions options;
  options.max_distance = -1;
  expectThrow<Error>(closest(options), {"max_distance", "-1"});
  options.max_distance = NAN;
  expectThrow<Error>(closest(options), {"max_distance", "nan"});
  options = {};
  options.facing = Points::Ones(2, 3);
  expectThrow<Error>(closest(options), {"facing", "2", "3"});
  options.facing = Points::Ones(3, 3);
  options.facing.row(1).setZero();
  expectThrow<Error>(closest(options), {"row 1", "facing", "length"});
  options.facing(1, 0) = NAN;
  expectThrow<Error>(closest(options), {"row 1", "facing", "finite"});
  options.facing.setOnes();
  options.max_angle = 3.2;
  expectThrow<Error>(closest(options), {"max_angle", "3.2"});
  options.max_angle = NAN;
  expectThrow<Error>(closest(options), {"max_angle"});
  expectThrow<Error>(closest({}, -1), {"threads", "-1"});
  EXPECT_EQ(search.closest(Points(0, 3)).at.size(), 0u);
}

TEST(Closest, OfASurfaceWithoutFacesIsNothing) {
  Cage cage = cube();
  cage.options.holes = {0, 1, 2, 3, 4, 5};
  const LimitSurface surface = limitSurface(cage);
  const SurfaceSearch search(surface);
  const Hits hits = search.closest(Points::Random(5, 3));
  for (const Location& at : hits.at) EXPECT_EQ(at.face, -1);
  EXPECT_TRUE(hits.distance.array().isNaN().all());
}

TEST(Closest, FromBeyondAllMeasureIsStillOfTheSurface) {
  const LimitSurface surface = limitSurface(perturbed(cube(), 0.2, 1));
  const SurfaceSearch search(surface);
  for (const double far : {1e9, 1e100, 1e149}) {
    Points point(1, 3);
    point << far, -far, 0.5 * far;
    const Hits hits = search.closest(point);
    EXPECT_GE(hits.at[0].face, 0) << far;
    EXPECT_NEAR(hits.distance[0] / far, 1.5, 1e-8) << far;
  }
  const Points beyond = Eigen::RowVector3d(1e160, 0, 0);
  expectThrow<std::invalid_argument>([&] { search.closest(beyond); }, {"row 0", "point", "1e+160"});
}

/// Points to which many places are about equally close: the worst case of branch and bound.
NamedCages roundCages() {
  return {{"cube", cube()},
          {"prism of 32", prism(32, false)},
          {"torus", torus(24, 16)},
          {"pole of 100", pole(100)},
          {"dome", [] {
             Cage cage = grid(12, 12);
             for (int v = 0; v < cage.vertexCount(); ++v) {
               Vector3 p = cage.positions.row(v).transpose() - Vector3(6, 6, -5);
               cage.positions.row(v) = p.normalized();
             }
             return cage;
           }()}};
}

TEST(Closest, IsFoundAtFocalPoints) {
  Random random(9);
  for (const auto& [name, cage] : roundCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const BruteForce truth(surface, 12);
    const double diagonal = truth.diagonal();
    std::vector<Vector3> rows = {Middle(surface).at, Vector3::Zero()};
    for (const double size : {1e-12, 1e-9, 1e-6, 1e-3}) {
      for (int i = 0; i < 3; ++i) {
        rows.push_back(Middle(surface).at + size * diagonal * random.vector(1));
        rows.push_back(size * diagonal * random.vector(1));
      }
      // The middle of the tube of a torus, and the axis of a prism.
      rows.push_back(Vector3(2, 0, 0) + size * diagonal * random.vector(1));
      rows.push_back(Vector3(0, 0, 0.3) + size * diagonal * random.vector(1));
    }
    compareWithBruteForce(name, truth, search, rowsOf(rows));
  }
}

/// Compares at centres of curvature, where the minimum is flat in one direction, of `count` places
/// on each cage.
void compareAtCentresOfCurvature(int count) {
  Random random(10);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const std::vector<Location> at = searchedLocations(surface, count, random);
    const Curvature curvature = surface.curvature(at);
    const Evaluation e = surface.evaluate(at, Derivatives::first, true);
    const double diagonal = Middle(surface).diagonal;
    std::vector<Vector3> rows;
    for (Eigen::Index i = 0; i < e.position.rows(); ++i) {
      for (const double k : {curvature.k1[i], curvature.k2[i]}) {
        const Vector3 centre = (e.position.row(i) + e.normal.row(i) / k).transpose();
        if (centre.allFinite() && centre.norm() < 1000 * diagonal) {
          rows.push_back(centre);
          rows.push_back(centre + 1e-9 * diagonal * random.vector(1));
        }
      }
    }
    if (rows.empty()) continue;
    const BruteForce truth(surface, 12);
    compareWithBruteForce(name, truth, search, rowsOf(rows));
  }
}

TEST(Closest, IsFoundAtCentresOfCurvature) { compareAtCentresOfCurvature(4); }

TEST(SlowClosest, IsFoundAtCentresOfCurvature) { compareAtCentresOfCurvature(60); }

TEST(SlowClosest, IsNearerThanWhatBruteForceFinds) { compareAll(queryCages(), 60, 24); }

}  // namespace
}  // namespace limitsurf::test
