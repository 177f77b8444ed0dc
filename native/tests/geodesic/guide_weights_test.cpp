// SPDX-License-Identifier: Apache-2.0
//
// Guides of children: distances along the surface against closed forms, cuts, weights.
#include "limitsurf/geodesic/guide_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <vector>

#include "limitsurf/geodesic/unfolding.h"
#include "limitsurf/pi.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

using Locations = std::vector<Location>;

Points positionsOf(const LimitSurface& surface, const Locations& at) {
  return surface.evaluate(at).position;
}

/// The distances of a result by guide: a row for each place.
Eigen::MatrixXd distancesByGuide(const GuideWeights& found, std::size_t guides) {
  const std::size_t rows = found.guide.size() / found.count;
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Constant(rows, guides, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < found.guide.size(); ++i) {
    if (found.guide[i] >= 0) {
      result(i / found.count, found.guide[i]) = found.distance[i];
    }
  }
  return result;
}

TEST(UnfoldedDistance, IsThatInThePlane) {
  const Eigen::Vector2d source(0.3, -2), a(0, 0), b(1, 0), c(0.4, 0.7);
  const TriangleSides sides{1, (c - a).norm(), (c - b).norm()};
  EXPECT_NEAR(unfoldedDistance((source - a).norm(), (source - b).norm(), sides),
              (source - c).norm(), 1e-15);
  // the straight way passes beside the side
  const Eigen::Vector2d beside(5, -1);
  EXPECT_TRUE(std::isinf(unfoldedDistance((beside - a).norm(), (beside - b).norm(), sides)));
  EXPECT_TRUE(std::isinf(unfoldedDistance(1, 1, {0, 1, 1})));
}

TEST(GuideWeights, AreEuclideanOnAFlatSheet) {
  Cage cage = fullGrid(4, 4);
  cage = perturbed(cage, 0.2, 5);
  cage.positions.col(2).setZero();
  const LimitSurface surface = limitSurface(cage);
  constexpr double kLargest = 5e-3;  // of a face's side, as the header states
  double worst = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const Locations guides = scatterJittered(surface, 1, 2 * seed);
    const Locations at = scatterJittered(surface, 6, 2 * seed + 1);
    const GuideWeights found = guideWeights(surface, guides, at);
    const Points p = positionsOf(surface, at), g = positionsOf(surface, guides);
    for (Eigen::Index row = 0; row < p.rows(); ++row) {
      Eigen::VectorXd truth = (g.rowwise() - p.row(row)).rowwise().norm();
      const std::size_t first = static_cast<std::size_t>(row) * 4;
      for (std::size_t k = first; k < first + 4; ++k) {
        EXPECT_NEAR(found.distance[k], truth(found.guide[k]), kLargest);
        worst = std::max(worst, std::abs(found.distance[k] - truth(found.guide[k])));
      }
      std::sort(truth.begin(), truth.end());
      EXPECT_NEAR(found.distance[first + 3], truth(3), kLargest);
    }
  }
  std::printf("worst error on a flat sheet: %.2g sides\n", worst);
}

/// A flat sheet of triangles, each square divided by either diagonal: vertices have 4 to 8 edges.
Cage flatTriangles(int side, std::uint64_t seed) {
  Cage cage = perturbed(fullGrid(side, side), 0.2, seed);
  cage.positions.col(2).setZero();
  Random random(seed);
  std::vector<std::vector<int>> triangles;
  for (const std::vector<int>& f : cage.faces) {
    const std::size_t k = random.uniform() < 0.5 ? 0 : 1;
    triangles.push_back({f[k], f[k + 1], f[k + 2]});
    triangles.push_back({f[k], f[k + 2], f[(k + 3) % 4]});
  }
  cage.faces = triangles;
  return cage;
}

TEST(GuideWeights, AreEuclideanOnTriangles) {
  // Next to irregular vertices u and v are uneven, so that locations do not lie where triangles
  // have them.
  for (const int side : {6, 48}) {
    const LimitSurface surface = limitSurface(flatTriangles(side, 3));
    Random random(7);
    const Locations guides = searchedLocations(surface, 24, random);
    const Locations at = searchedLocations(surface, 4000, random);
    const GuideWeights found = guideWeights(surface, guides, at);
    const Points p = positionsOf(surface, at), g = positionsOf(surface, guides);
    double worst = 0;
    for (Eigen::Index row = 0; row < p.rows(); ++row) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t entry = 4 * static_cast<std::size_t>(row) + k;
        const double truth = (p.row(row) - g.row(found.guide[entry])).norm();
        const double error = std::abs(found.distance[entry] - truth) / std::max(truth, 1. / 8);
        EXPECT_LT(error, kGuideDistanceError) << side << " x " << side << ", row " << row;
        worst = std::max(worst, error);
      }
    }
    std::printf("worst error on %d x %d squares of two triangles: %.2g\n", side, side, worst);
  }
}

TEST(GuideWeights, AreEuclideanAmongManyGuides) {
  // Guides are as near to each other as the triangles' vertices are, which do not all keep the
  // guides that are nearest to a place between them.
  std::size_t far = 0, wrong = 0, missed = 0;
  double worst = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const LimitSurface surface = limitSurface(flatTriangles(6, seed));
    Random random(seed);
    const Locations guides = searchedLocations(surface, 1500, random);
    const Locations at = searchedLocations(surface, 3000, random);
    const GuideWeights found = guideWeights(surface, guides, at);
    const Points p = positionsOf(surface, at), g = positionsOf(surface, guides);
    for (Eigen::Index row = 0; row < p.rows(); ++row) {
      std::vector<double> truth;
      for (Eigen::Index guide = 0; guide < g.rows(); ++guide) {
        truth.push_back((p.row(row) - g.row(guide)).norm());
      }
      std::vector<double> nearest = truth;
      std::partial_sort(nearest.begin(), nearest.begin() + 4, nearest.end());
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t entry = 4 * static_cast<std::size_t>(row) + k;
        const double distance = truth[found.guide[entry]];
        missed += distance > nearest[k] + 1e-4;
        if (distance < 1. / 8) continue;
        const double error = std::abs(found.distance[entry] / distance - 1);
        ++far;
        wrong += error > kGuideDistanceError;
        worst = std::max(worst, error);
      }
    }
  }
  std::printf("of %zu distances %zu are off by more than 1 %%, %.1f %% at most; %zu missed\n", far,
              wrong, 100 * worst, missed);
  EXPECT_LE(wrong, far / 2500);
  EXPECT_LE(missed, 15);
  EXPECT_LT(worst, 0.04);
}

TEST(GuideWeights, GoAroundATorus) {
  const LimitSurface surface = limitSurface(torus(24, 12));
  const Locations all = scatterJittered(surface, 1, 1);
  const Locations guides = {all[0], all[30], all[100], all[170], all[250]};
  GuideOptions options;
  options.count = 5;
  const Eigen::MatrixXd there =
      distancesByGuide(guideWeights(surface, guides, all, options), guides.size());
  // distances are symmetric, and no shorter than chords
  const Points p = positionsOf(surface, all), g = positionsOf(surface, guides);
  for (std::size_t row = 0; row < all.size(); ++row) {
    for (std::size_t k = 0; k < guides.size(); ++k) {
      const double chord = (p.row(row) - g.row(k)).norm();
      EXPECT_GE(there(row, k), chord * (1 - 1e-3) - 1e-9);
    }
  }
  const Eigen::MatrixXd back =
      distancesByGuide(guideWeights(surface, Locations{all[200]}, guides, options), 1);
  for (std::size_t k = 0; k < guides.size(); ++k) {
    EXPECT_NEAR(back(k, 0), there(200, k), kGuideDistanceError * there(200, k));
  }
}

TEST(GuideWeights, AreGeodesicOnACylinder) {
  for (const int sides : {12, 24, 72}) {  // the last have larger triangles far from the guides
    Cage cage = fullGrid(sides, sides);
    for (auto& face : cage.faces) {  // the last column of vertices is the first
      for (int& vertex : face) {
        vertex -= vertex % (sides + 1) == sides ? sides : 0;
      }
    }
    const double height = 2 * kPi<double>;
    for (Eigen::Index vertex = 0; vertex < cage.positions.rows(); ++vertex) {
      const double turn = 2 * kPi<double> * cage.positions(vertex, 0) / sides;
      const double z = height * cage.positions(vertex, 1) / sides;
      cage.positions.row(vertex) << std::cos(turn), std::sin(turn), z;
    }
    const LimitSurface surface = limitSurface(cage);
    const Locations all = scatterJittered(surface, 1, 9);
    const Locations guides = {all[3], all[40], all[77]};
    GuideOptions options;
    options.count = 3;
    const Eigen::MatrixXd found =
        distancesByGuide(guideWeights(surface, guides, all, options), guides.size());
    const Points p = positionsOf(surface, all), g = positionsOf(surface, guides);
    for (Eigen::Index row = 0; row < p.rows(); ++row) {
      for (Eigen::Index k = 0; k < g.rows(); ++k) {
        const double radius = p.row(row).head<2>().norm();
        const double turn = std::abs(std::remainder(
            std::atan2(p(row, 1), p(row, 0)) - std::atan2(g(k, 1), g(k, 0)), 2 * kPi<double>));
        const double truth = std::hypot(radius * turn, p(row, 2) - g(k, 2));
        EXPECT_NEAR(found(row, k), truth, kGuideDistanceError * std::max(truth, height / sides / 8))
            << sides;
      }
    }
  }
}

TEST(GuideWeights, DoNotCrossCuts) {
  Cage cage = fullGrid(4, 4);
  const LimitSurface surface = limitSurface(cage);
  const auto place = [](double x, double y) {
    return Location{static_cast<int>(x) + 4 * static_cast<int>(y), x - std::floor(x),
                    y - std::floor(y)};
  };
  const Locations guides = {place(1.9, 0.5), place(2.1, 3.5)};
  const Locations at = {place(2.1, 0.5), place(1.9, 3.5), place(0.5, 2.5)};
  GuideOptions options;
  options.count = 2;
  // from the border to the middle: ways go around the end
  options.cuts = {{2, 7}, {12, 7}};
  const Eigen::MatrixXd around = distancesByGuide(guideWeights(surface, guides, at, options), 2);
  const Points p = positionsOf(surface, at), g = positionsOf(surface, guides);
  const Vector3 end = surface.evaluate(Locations{place(2, 2)}).position.row(0).transpose();
  const auto by_end = [&](const auto& a, const auto& b) {
    return (Vector3(a) - end).norm() + (end - Vector3(b)).norm();
  };
  EXPECT_NEAR(around(0, 0), by_end(p.row(0), g.row(0)), 0.01 * around(0, 0));
  EXPECT_NEAR(around(1, 1), (p.row(1) - g.row(1)).norm(), 1e-3);
  // all the way: nothing gets across
  for (const int row : {2, 3}) {
    options.cuts.push_back({2 + 5 * row, 2 + 5 * (row + 1)});
  }
  const GuideWeights apart = guideWeights(surface, guides, at, options);
  EXPECT_EQ(apart.guide, (std::vector<std::int32_t>{1, -1, 0, -1, 0, -1}));
  EXPECT_EQ(apart.weight, (std::vector<double>{1, 0, 1, 0, 1, 0}));
  EXPECT_TRUE(std::isinf(apart.distance[1]));
}

TEST(GuideWeights, DoNotCrossTheGapBetweenSheets) {
  Cage cage = fullGrid(3, 3);
  const int vertices = cage.vertexCount();
  const std::vector<std::vector<int>> below = cage.faces;
  cage.positions.conservativeResize(2 * vertices, 3);
  cage.positions.bottomRows(vertices) = cage.positions.topRows(vertices);
  cage.positions.bottomRows(vertices).col(2).setConstant(1e-6);
  for (std::vector<int> face : below) {
    for (int& vertex : face) {
      vertex += vertices;
    }
    cage.faces.push_back(face);
  }
  const LimitSurface surface = limitSurface(cage);
  const Locations at = scatterJittered(surface, 2, 0);
  const GuideWeights found = guideWeights(surface, Locations{{4, 0.5, 0.5}, {13, 0.5, 0.5}}, at);
  for (std::size_t row = 0; row < at.size(); ++row) {
    EXPECT_EQ(found.guide[4 * row], at[row].face / 9);
    EXPECT_EQ(found.guide[4 * row + 1], -1);
  }
}

TEST(GuideWeights, EndAmongLongThinTriangles) {
  // Distances are told of every 2^16 steps: the triangles around this pole have 2^17 corners.
  const LimitSurface surface = limitSurface(pole(100));
  int reports = 0;
  GuideOptions options;
  options.progress = [&reports](double) {
    if (++reports > 500) {
      throw std::runtime_error("distances are spread without end");
    }
  };
  Random random(8);
  const Locations at = searchedLocations(surface, 8, random);
  const GuideWeights found = guideWeights(surface, Locations{at[0]}, at, options);
  EXPECT_GT(reports, 0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double straight = (positionsOf(surface, {at[i]}) - positionsOf(surface, {at[0]})).norm();
    EXPECT_GE(found.distance[i * found.count], straight * (1 - kGuideDistanceError));
  }
}

TEST(GuideWeights, FadeWhereAnotherGuideTakesOver) {
  const double distances[4] = {1, 2, 3, 4};
  double weights[4];
  weightsByDistance(distances, 4, 4, weights);
  EXPECT_EQ(weights[3], 0);
  EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1, 1e-15);
  EXPECT_NEAR(weights[0] / weights[1], std::pow((0.75 / 1) / (0.5 / 2), 2), 1e-12);
  const double at_guide[2] = {0, 1};
  weightsByDistance(at_guide, 2, 2, weights);
  EXPECT_EQ(weights[0], 1);
  EXPECT_EQ(weights[1], 0);
  const double alike[2] = {1, 1};
  weightsByDistance(alike, 2, 1, weights);
  EXPECT_EQ(weights[0], 0.5);
}

TEST(SlowGuideWeights, AreTheSameForAnyNumberOfThreads) {
  const LimitSurface surface = limitSurface(mixture(4));
  Locations at = scatterJittered(surface, 8, 2);
  at.erase(std::remove_if(at.begin(), at.end(),
                          [&](const Location& l) {
                            return surface.refused().count(surface.baseFace()[l.face]) > 0;
                          }),
           at.end());
  Locations guides;
  for (std::size_t i = 0; i < at.size(); i += 97) {
    guides.push_back(at[i]);
  }
  GuideOptions all, one;
  all.count = one.count = 2;
  one.threads = 1;
  const GuideWeights a = guideWeights(surface, guides, at, all),
                     b = guideWeights(surface, guides, at, one);
  EXPECT_EQ(a.guide, b.guide);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.distance, b.distance);
  // a row does not depend on the others
  const GuideWeights alone = guideWeights(surface, guides, Locations{at[11]}, all);
  EXPECT_TRUE(std::equal(alone.weight.begin(), alone.weight.end(), a.weight.begin() + 22));
}

TEST(GuideWeights, NameWhatIsWrong) {
  const LimitSurface surface = limitSurface(fullGrid(2, 2));
  const Locations at = {{0, 0.5, 0.5}};
  GuideOptions options;
  options.cuts = {{0, 1}, {0, 4}};
  expectThrow<MeshError>([&] { guideWeights(surface, at, at, options); }, {"row 1"});
  options.cuts.clear();
  options.count = 17;
  expectThrow<std::invalid_argument>([&] { guideWeights(surface, at, at, options); }, {"17"});
  expectThrow<LocationError>([&] { guideWeights(surface, Locations{{9, 0, 0}}, at); }, {"face 9"});
}

}  // namespace
}  // namespace limitsurf::test
