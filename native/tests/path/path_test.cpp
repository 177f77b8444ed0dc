// SPDX-License-Identifier: Apache-2.0
//
// Paths on the surface, on all the cages of the searches: compared with dense samples of what was
// laid and fitted, and with each other for different numbers of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "limitsurf/path/laid_path.h"
#include "limitsurf/path/path_fit.h"
#include "limitsurf/path/path_smoothing.h"
#include "support/cages/cage_builder.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

constexpr int kDense = 20;  ///< samples on each segment
constexpr double kDirectly = 1e-3;

double diagonalOf(const LimitSurface& surface) {
  return (surface.positions().colwise().maxCoeff() - surface.positions().colwise().minCoeff())
      .norm();
}

/// Curves of three points each near the surface.
SpaceCurves randomCurves(const LimitSurface& surface, int count, Random& random) {
  SpaceCurves curves;
  const Points on =
      surface.evaluate(searchedLocations(surface, 3 * count, random)).position.topRows(3 * count);
  curves.points = on;
  for (Eigen::Index i = 0; i < curves.points.rows(); ++i) {
    curves.points.row(i) += 0.01 * diagonalOf(surface) * random.vector(1).transpose();
  }
  curves.offsets.push_back(0);
  for (int i = 1; i <= count; ++i) {
    curves.offsets.push_back(3 * i);
    curves.closed.push_back(i % 2 == 0);
  }
  return curves;
}

/// Two flat sheets, one above the other.
Cage twoSheets(int size, double height) {
  CageBuilder builder;
  builder.append(fullGrid(size, size));
  builder.append(placed(fullGrid(size, size), 1, {0, 0, height}));
  return builder.build();
}

/// The largest distance from the surface on the polyline through these rows.
double densest(const SurfaceSearch& search, const Points& rows) {
  if (rows.rows() < 2) return 0;
  Points samples((rows.rows() - 1) * kDense, 3);
  for (Eigen::Index i = 0; i + 1 < rows.rows(); ++i) {
    for (int j = 0; j < kDense; ++j) {
      const double t = (j + 0.5) / kDense;
      samples.row(i * kDense + j) = (1 - t) * rows.row(i) + t * rows.row(i + 1);
    }
  }
  return search.closest(samples).distance.maxCoeff();
}

void layOn(const NamedCages& cages) {
  Random random(1);
  double worst = 0;
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double tolerance = kDirectly * diagonalOf(surface);
    const SpaceCurves curves = randomCurves(surface, 2, random);
    // Features of these cages are wider than the places at which such steps are measured.
    const LaidPaths laid =
        layCurves(surface, search, curves, {tolerance, diagonalOf(surface) / 50, 0});
    ASSERT_EQ(laid.offsets.back(), laid.position.rows()) << name;
    for (std::size_t path = 0; path < laid.curve.size(); ++path) {
      const std::int64_t begin = laid.offsets[path], end = laid.offsets[path + 1];
      ASSERT_LT(begin, end) << name;
      const Points rows = laid.position.middleRows(begin, end - begin);
      const double found = densest(search, rows);
      EXPECT_LE(laid.deviation[path], tolerance) << name;
      EXPECT_LE(found, 1.05 * tolerance) << name << ", path " << path;
      worst = std::max(worst, found / tolerance);
      if (laid.closed[path]) {
        EXPECT_TRUE(rows.row(0) == rows.row(rows.rows() - 1)) << name;
      }
    }
    const Points exact = surface.evaluate(laid.at).position;
    EXPECT_LE((exact - laid.position).cwiseAbs().maxCoeff(), kPositionError * diagonalOf(surface))
        << name;
  }
  std::printf("largest distance by %d samples a segment: %.3f tolerances\n", kDense, worst);
}

TEST(Path, LaidOnTheSurfaceItIsWithinTheTolerance) { layOn(everyNth(queryCages(), 4)); }

TEST(SlowPath, LaidOnEveryCageItIsWithinTheTolerance) { layOn(queryCages()); }

TEST(Path, ResultsDependNeitherOnThreadsNorOnTheOtherCurves) {
  Random random(2);
  const LimitSurface surface = limitSurface(perturbed(grid(6, 5), 0.2, 3));
  const SurfaceSearch search(surface);
  const SpaceCurves all = randomCurves(surface, 20, random);
  const LaidPaths together = layCurves(surface, search, all, {1e-3, 1e300, 0});
  const LaidPaths serial = layCurves(surface, search, all, {1e-3, 1e300, 1});
  EXPECT_TRUE(together.position == serial.position);
  EXPECT_EQ(together.deviation, serial.deviation);
  EXPECT_EQ(together.place, serial.place);
  for (std::size_t path = 0; path < together.curve.size(); ++path) {
    const auto curve = static_cast<Eigen::Index>(together.curve[path]);
    if (std::count(together.curve.begin(), together.curve.end(), curve) > 1) continue;
    SpaceCurves one;
    one.points = all.points.middleRows(3 * curve, 3);
    one.offsets = {0, 3};
    one.closed = {all.closed[static_cast<std::size_t>(curve)]};
    const LaidPaths alone = layCurves(surface, search, one, {1e-3, 1e300, 0});
    const std::int64_t begin = together.offsets[path], end = together.offsets[path + 1];
    ASSERT_EQ(alone.position.rows(), end - begin);
    EXPECT_TRUE(alone.position == together.position.middleRows(begin, end - begin));
  }
}

TEST(Path, StraightLinesThroughAClosedSurfaceAreJoinedAroundIt) {
  Random random(5);
  for (const auto& [name, cage] :
       {std::pair{"cube", cube()}, {"dented", perturbed(cube(), 0.2, 2)}}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    SpaceCurves curves;
    curves.offsets.push_back(0);
    curves.points = surface.evaluate(searchedLocations(surface, 120, random)).position.topRows(120);
    for (int i = 1; i <= 60; ++i) {
      curves.offsets.push_back(2 * i);
      curves.closed.push_back(0);
    }
    const double tolerance = kDirectly * diagonalOf(surface);
    const LaidPaths laid =
        layCurves(surface, search, curves, {tolerance, diagonalOf(surface) / 50, 0});
    ASSERT_EQ(laid.curve.size(), 60u) << name;
    for (std::size_t path = 0; path < 60; ++path) {
      const std::int64_t begin = laid.offsets[path], end = laid.offsets[path + 1];
      const Points rows = laid.position.middleRows(begin, end - begin);
      EXPECT_LE(laid.deviation[path], tolerance) << name;
      EXPECT_LE(densest(search, rows), 1.05 * tolerance) << name;
      const Eigen::VectorXd steps =
          (rows.bottomRows(rows.rows() - 1) - rows.topRows(rows.rows() - 1)).rowwise().norm();
      EXPECT_LE(steps.maxCoeff(), diagonalOf(surface) / 50 * (1 + 1e-12)) << name;
    }
    const Points exact = surface.evaluate(laid.at).position;
    EXPECT_LE((exact - laid.position).cwiseAbs().maxCoeff(), kPositionError * diagonalOf(surface))
        << name;
  }
}

TEST(Path, SeparatePartsAreNotJoined) {
  const LimitSurface surface = limitSurface(twoSheets(3, 0.5));
  const SurfaceSearch search(surface);
  SpaceCurves curves;
  curves.points.resize(2, 3);
  curves.points << 1, 1, 0, 2, 2, 0.5;
  curves.offsets = {0, 2};
  curves.closed = {0};
  const LaidPaths laid = layCurves(surface, search, curves, {1e-3, 0.1, 0});
  ASSERT_EQ(laid.curve.size(), 2u);
  EXPECT_LE(laid.position.topRows(laid.offsets[1]).col(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GE(laid.position.bottomRows(laid.position.rows() - laid.offsets[1]).col(2).minCoeff(),
            0.5 - 1e-12);
}

TEST(Path, PartsBesideTheWayAreLeftOutUnlessAControlPointLiesThere) {
  // a flat sheet, and above its middle a smaller one to which the middle of the curve is closer
  CageBuilder builder;
  builder.append(fullGrid(4, 4));
  builder.append(placed(fullGrid(2, 2), 0.25, {1.75, 1.75, 0.5}));
  const LimitSurface surface = limitSurface(builder.build());
  const SurfaceSearch search(surface);
  SpaceCurves curves;
  curves.points.resize(2, 3);
  curves.points << 1, 2, 0.4, 3, 2, 0.4;
  curves.offsets = {0, 2};
  curves.closed = {0};
  const LayOptions options{1e-3, 0.1, 0};
  const LaidPaths past = layCurves(surface, search, curves, options);
  ASSERT_EQ(past.curve.size(), 1u);
  EXPECT_LE(past.position.col(2).cwiseAbs().maxCoeff(), 1e-12);
  curves.points.resize(3, 3);
  curves.points << 1, 2, 0.4, 2, 2, 0.4, 3, 2, 0.4;
  curves.offsets = {0, 3};
  EXPECT_EQ(layCurves(surface, search, curves, options).curve.size(), 3u);
}

TEST(Path, BesideAnotherPartAnOffsetIsCountedFromTheOwnOne) {
  const LimitSurface alone = limitSurface(fullGrid(4, 4));
  const LimitSurface surface = limitSurface(twoSheets(4, 0.05));
  const SurfaceSearch search(surface), search_alone(alone);
  SpaceCurves curves;
  curves.points.resize(3, 3);
  curves.points << 1, 1, 0, 2, 1.2, 0, 3, 3, 0;
  curves.offsets = {0, 3};
  curves.closed = {0};
  const LaidPaths laid = layCurves(surface, search, curves, {2.5e-4, 0.05, 0});
  ASSERT_EQ(laid.curve.size(), 1u);
  for (const FitKind kind : {FitKind::bezier, FitKind::poly}) {
    FitOptions options;
    options.kind = kind;
    options.tolerance = 1e-3;
    options.offset = 0.04;
    const PathFit fit = fitPath(surface, search, laid.at, options);
    EXPECT_EQ(fit.rows, fitPath(alone, search_alone, laid.at, options).rows);
    EXPECT_LE(fit.deviation, options.tolerance);
    options.offset = 0.01;  // the other part is farther away than the own one
    EXPECT_EQ(fitPath(surface, search, laid.at, options).rows, fit.rows);
  }
}

void fitOn(const NamedCages& cages) {
  Random random(4);
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const double tolerance = kDirectly * diagonalOf(surface);
    const LaidPaths laid =
        layCurves(surface, search, randomCurves(surface, 2, random), {tolerance / 4, 1e300, 0});
    for (std::size_t path = 0; path < laid.curve.size(); ++path) {
      const auto begin = laid.at.begin() + laid.offsets[path];
      const auto end = laid.at.begin() + laid.offsets[path + 1];
      if (end - begin < 2) continue;
      FitOptions options;
      options.tolerance = tolerance;
      options.closed = laid.closed[path];
      const PathFit fit = fitPath(surface, search, {begin, end}, options);
      EXPECT_LE(fit.deviation, tolerance) << name;
      EXPECT_LE(fit.error, 0.6 * tolerance) << name;
      Points samples(static_cast<Eigen::Index>(fit.rows.size() - 1) * kDense, 3);
      for (std::size_t i = 0; i + 1 < fit.rows.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const Vector3 from = laid.position.row(laid.offsets[path] + fit.rows[i]);
        const Vector3 to = laid.position.row(laid.offsets[path] + fit.rows[i + 1]);
        for (int j = 0; j < kDense; ++j) {
          samples.row(row * kDense + j) =
              bezierPoint({from, fit.after.row(row), fit.before.row(row + 1), to},
                          (j + 0.5) / kDense)
                  .transpose();
        }
      }
      EXPECT_LE(search.closest(samples).distance.maxCoeff(), 1.3 * tolerance)
          << name << ", path " << path;
    }
  }
}

TEST(Path, FitsAreWithinTheTolerance) { fitOn(everyNth(queryCages(), 6)); }

TEST(SlowPath, FitsOnEveryCageAreWithinTheTolerance) { fitOn(queryCages()); }

TEST(Path, SmoothedOnAFlatSheetItStaysAndBecomesStraight) {
  const LimitSurface surface = limitSurface(fullGrid(4, 4));
  const SurfaceSearch search(surface);
  Points points(21, 3);
  for (int i = 0; i <= 20; ++i) {
    points.row(i) << 1 + 0.1 * i, 1.5 + (i % 2 ? 0.1 : 0) + 0.02 * i, 0;
  }
  const Hits hits = search.closest(points);
  const PathPoints smooth =
      smoothPath(surface, search, hits.at, Eigen::VectorXd::Ones(21), 3000, false);
  for (int i = 0; i <= 20; ++i) {
    EXPECT_NEAR(smooth.position(i, 2), 0, 1e-14);
    const double part = (smooth.position(i, 0) - 1) / 2;
    EXPECT_NEAR(smooth.position(i, 1), 1.5 + 0.4 * part, 1e-6) << i;
  }
  EXPECT_TRUE(smooth.position.row(0) == hits.position.row(0));
  EXPECT_TRUE(smooth.position.row(20) == hits.position.row(20));
}

TEST(Path, ErrorsNameTheArgument) {
  const LimitSurface surface = limitSurface(fullGrid(2, 2));
  const SurfaceSearch search(surface);
  SpaceCurves curves;
  curves.points = Points::Zero(2, 3);
  curves.offsets = {0, 2};
  curves.closed = {0};
  using Invalid = std::invalid_argument;
  expectThrow<Invalid>([&] { layCurves(surface, search, curves, {0, 1, 0}); }, {"tolerance is 0"});
  expectThrow<Invalid>([&] { layCurves(surface, search, curves, {1, 0, 0}); }, {"max_step is 0"});
  curves.offsets = {0, 1};
  expectThrow<Invalid>([&] { layCurves(surface, search, curves, {1, 1, 0}); }, {"offsets"});
  FitOptions options;
  expectThrow<Invalid>([&] { fitPath(surface, search, {{0, 0, 0}}, options); }, {"tolerance is 0"});
  options.tolerance = 1;
  expectThrow<Invalid>([&] { fitPath(surface, search, {{0, 0, 0}}, options); }, {"1 points"});
}

}  // namespace
}  // namespace limitsurf::test
