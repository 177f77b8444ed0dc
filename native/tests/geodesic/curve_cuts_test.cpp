// SPDX-License-Identifier: Apache-2.0
//
// Curves that no way along a surface crosses: distances around their ends against closed forms, and
// that nothing gets across.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>

#include "limitsurf/geodesic/guide_weights.h"
#include "limitsurf/pi.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

using Locations = std::vector<Location>;
using Curve = std::vector<Vector3>;

Polylines polylines(const std::vector<Curve>& curves) {
  Polylines made{Points(0, 3), {0}};
  for (const Curve& curve : curves) {
    for (const Vector3& point : curve) {
      made.points.conservativeResize(made.points.rows() + 1, 3);
      made.points.bottomRows<1>() = point.transpose();
    }
    made.offsets.push_back(made.points.rows());
  }
  return made;
}

GuideOptions cutBy(const std::vector<Curve>& curves, int count = 4) {
  GuideOptions options;
  options.count = count;
  options.cut_curves = polylines(curves);
  return options;
}

/// A flat sheet from (0, 0) to (n, n) whose vertices are moved.
LimitSurface flatSheet(int n, double moved = 0.2) {
  Cage cage = perturbed(fullGrid(n, n), moved, 11);
  cage.positions.col(2).setZero();
  return limitSurface(cage);
}

Locations locationsOf(const LimitSurface& surface, const Points& points) {
  return SurfaceSearch(surface).closest(points).at;
}

/// Random places, and places right beside a straight line on both of its sides.
Locations placesAbout(const LimitSurface& surface, const Vector3& from, const Vector3& to,
                      double beside) {
  Locations at = scatterJittered(surface, 4, 5);
  const Vector3 across = Vector3(from.y() - to.y(), to.x() - from.x(), 0).normalized();
  Points points(400, 3);
  for (int i = 0; i < 200; ++i) {
    const Vector3 middle = from + (i + 0.5) / 200 * (to - from);
    points.row(2 * i) = middle + beside * across;
    points.row(2 * i + 1) = middle - beside * across;
  }
  const Locations near = locationsOf(surface, points);
  at.insert(at.end(), near.begin(), near.end());
  return at;
}

double leftOf(const Vector3& from, const Vector3& to, const Vector3& p) {
  return (to.x() - from.x()) * (p.y() - from.y()) - (to.y() - from.y()) * (p.x() - from.x());
}

/// Checks that no guide is on the other side of a curve; sideOf() tells the sides apart.
template <typename SideOf>
void expectNothingCrosses(const LimitSurface& surface, const Locations& guides, const Locations& at,
                          const GuideOptions& options, const SideOf& side) {
  const GuideWeights found = guideWeights(surface, guides, at, options);
  const Points p = surface.evaluate(at).position, g = surface.evaluate(guides).position;
  int reached = 0;
  for (std::size_t row = 0; row < at.size(); ++row) {
    const int here = side(Vector3(p.row(static_cast<Eigen::Index>(row))));
    for (int k = 0; k < found.count; ++k) {
      const std::int32_t guide = found.guide[row * found.count + k];
      if (guide >= 0) {
        EXPECT_EQ(static_cast<int>(side(Vector3(g.row(guide)))), here)
            << p.row(static_cast<Eigen::Index>(row)) << " and " << g.row(guide);
        ++reached;
      }
    }
  }
  EXPECT_GT(reached, static_cast<int>(at.size()));
}

struct Line {
  double moved;  ///< of the sheet's vertices
  Vector3 from, to;
};

void expectSidesApart(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    const LimitSurface surface = flatSheet(6, line.moved);
    const Locations at = placesAbout(surface, line.from, line.to, 1e-3);
    expectNothingCrosses(surface, scatterJittered(surface, 2, 3), at, cutBy({{line.from, line.to}}),
                         [&](const Vector3& p) { return leftOf(line.from, line.to, p) > 0; });
  }
}

TEST(CurveCuts, KeepTheSidesOfALineApart) {
  expectSidesApart({{0.2, {-1, 2.2, 0.3}, {7, 4.9, -0.2}}});
}

TEST(SlowCurveCuts, KeepTheSidesOfALineApart) {
  expectSidesApart({{0, {3, -1, 0}, {3, 7, 0}},
                    {0.2, {2.7, -0.5, 0}, {3.1, 6.5, 0}},
                    {0, {-1, -1, 0}, {7, 7, 0}}});
}

TEST(CurveCuts, MayLieOnEdgesAndPassThroughVertices) {
  const LimitSurface surface = limitSurface(fullGrid(4, 4));
  const double x = surface.evaluate(Locations{{1, 1, 0.5}}).position(0, 0);
  const Vector3 a(x, 0, 0), b(x, 4, 0);
  Locations at = scatterJittered(surface, 4, 5);
  expectNothingCrosses(surface, scatterJittered(surface, 2, 3), at, cutBy({{a, b}}),
                       [&](const Vector3& p) { return p.x() < x; });
}

TEST(CurveCuts, KeepInsideAndOutsideOfAClosedCurveApart) {
  const LimitSurface surface = flatSheet(6);
  Curve circle;
  const int count = 240;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * kPi<double> * i / count;
    circle.emplace_back(3 + 1.7 * std::cos(turn), 3 + 1.7 * std::sin(turn), 0);
  }
  circle.push_back(circle.front());
  Locations at = scatterJittered(surface, 8, 5);
  const Points p = surface.evaluate(at).position;
  Locations clear;  // the curve consists of chords
  for (std::size_t row = 0; row < at.size(); ++row) {
    const double away =
        (p.row(static_cast<Eigen::Index>(row)) - Eigen::RowVector3d(3, 3, 0)).norm();
    if (std::abs(away - 1.7) > 2e-3) {
      clear.push_back(at[row]);
    }
  }
  expectNothingCrosses(surface, scatterJittered(surface, 2, 3), clear, cutBy({circle}),
                       [](const Vector3& q) { return (q - Vector3(3, 3, 0)).norm() < 1.7; });
}

/// The straight distance, or that around the end of a line from the border where it is in the way.
double aroundEnd(const Vector3& a, const Vector3& b, const Vector3& end) {
  const bool crosses = (a.x() - end.x()) * (b.x() - end.x()) < 0;
  const double share = crosses ? (end.x() - a.x()) / (b.x() - a.x()) : 0;
  const bool is_behind = crosses && a.y() + share * (b.y() - a.y()) < end.y();
  return is_behind ? (a - end).norm() + (end - b).norm() : (a - b).norm();
}

TEST(SlowCurveCuts, LeadAroundTheirEnds) {
  const LimitSurface surface = flatSheet(6);
  const Vector3 end(3.05, 2.6, 0);
  const Locations guides = scatterJittered(surface, 1, 3), at = scatterJittered(surface, 4, 5);
  const int count = GuideOptions::kMostGuides;
  const GuideWeights found =
      guideWeights(surface, guides, at, cutBy({{Vector3(3.05, -1, 0), end}}, count));
  const Points p = surface.evaluate(at).position, g = surface.evaluate(guides).position;
  int around = 0;
  for (std::size_t row = 0; row < at.size(); ++row) {
    const Vector3 here = p.row(static_cast<Eigen::Index>(row));
    for (int k = 0; k < count; ++k) {
      const std::size_t entry = row * count + k;
      const Vector3 there = g.row(found.guide[entry]);
      const double truth = aroundEnd(here, there, end);
      EXPECT_NEAR(found.distance[entry], truth, 0.01 * truth + 2e-3) << here << "\n" << there;
      around += truth > (here - there).norm() * 1.001;
    }
  }
  EXPECT_GT(around, 300);
}

/// Cut along edges, with few guides, so that ways begin and end within a face of the end.
TEST(CurveCuts, LeadAroundTheirEndsFromGuidesNearThem) {
  const LimitSurface surface = flatSheet(6, 0);
  const Vector3 end(3, 3, 0);
  GuideOptions options;
  options.count = 2;
  for (int y = 0; y < 3; ++y) {
    options.cuts.emplace_back(7 * y + 3, 7 * (y + 1) + 3);
  }
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> offset(-0.9, 0.9);
  const auto placesNearEnd = [&](Eigen::Index count) {
    Points points = Points::Zero(count, 3);
    for (Eigen::Index i = 0; i < count; ++i) {
      points.row(i) << end.x() + offset(random), end.y() + offset(random), 0;
    }
    return locationsOf(surface, points);
  };
  int measured = 0, inexact = 0;
  double worst = 0;
  for (int arrangement = 0; arrangement < 30; ++arrangement) {
    const Locations guides = placesNearEnd(5), at = placesNearEnd(500);
    const GuideWeights found = guideWeights(surface, guides, at, options);
    const Points p = surface.evaluate(at).position, g = surface.evaluate(guides).position;
    for (std::size_t entry = 0; entry < found.guide.size(); ++entry) {
      const double truth =
          aroundEnd(p.row(static_cast<Eigen::Index>(entry / 2)), g.row(found.guide[entry]), end);
      if (truth >= 0.125) {
        const double error = std::abs(found.distance[entry] - truth) / truth;
        worst = std::max(worst, error);
        inexact += error > kGuideDistanceError;
        ++measured;
      }
    }
  }
  std::printf("  worst %.4f; %d of %d above 1 %%\n", worst, inexact, measured);
  EXPECT_GT(measured, 25000);
  EXPECT_LE(worst, 0.04);
  EXPECT_LE(inexact, measured / 50);
}

TEST(CurveCuts, AreGeodesicOnACylinder) {
  const int sides = 24;
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
  const double cut = 0.4;  // the angle of a line from end to end, which floats above the surface
  const Vector3 beside(1.2 * std::cos(cut), 1.2 * std::sin(cut), 0);
  const Curve line = {beside, beside + Vector3(0, 0, height)};
  const Locations at = scatterJittered(surface, 1, 9);
  const Locations guides = {at[3], at[40], at[77], at[300]};
  const GuideWeights found = guideWeights(surface, guides, at, cutBy({line}));
  const Points p = surface.evaluate(at).position, g = surface.evaluate(guides).position;
  const auto angle = [&](const Points& rows, Eigen::Index row) {
    const double turn = std::atan2(rows(row, 1), rows(row, 0)) - cut;
    return turn < 0 ? turn + 2 * kPi<double> : turn;  // since the cut
  };
  int detours = 0;
  for (std::size_t entry = 0; entry < found.guide.size(); ++entry) {
    const Eigen::Index row = static_cast<Eigen::Index>(entry) / 4;
    ASSERT_GE(found.guide[entry], 0);
    const double radius = p.row(row).head<2>().norm();
    const double turn = std::abs(angle(p, row) - angle(g, found.guide[entry]));
    const double truth = std::hypot(radius * turn, p(row, 2) - g(found.guide[entry], 2));
    EXPECT_NEAR(found.distance[entry], truth, kGuideDistanceError * std::max(truth, height / 200));
    detours += turn > kPi<double>;
  }
  EXPECT_GT(detours, 100);
}

void expectParts(bool stem_first) {
  const LimitSurface surface = flatSheet(6, 0);
  // a T of float32 coordinates, whose stem ends a little before the bar and the border
  const Vector3 left(0, 3.5, 0), right(6, 3.5, 0), top(2.5, 3.5 - 1e-6, 0), foot(2.5, 1e-6, 0);
  std::vector<Curve> curves = {{top, foot}, {left, right}};
  if (!stem_first) {
    std::swap(curves[0], curves[1]);
  }
  expectNothingCrosses(surface, scatterJittered(surface, 2, 3), scatterJittered(surface, 4, 5),
                       cutBy(curves), [](const Vector3& p) {
                         return p.y() > 3.5 ? 0 : p.x() < 2.5 ? 1 : 2;
                       });
}

TEST(CurveCuts, EndAtOtherCurvesAndAtBordersThatTheyNearlyReach) { expectParts(true); }

TEST(SlowCurveCuts, EndAtOtherCurvesInAnyOrder) { expectParts(false); }

TEST(CurveCuts, CrossEachOtherAndEdges) {
  const LimitSurface surface = flatSheet(4, 0);
  GuideOptions options =
      cutBy({{Vector3(0, 1.3, 0), Vector3(4, 2.9, 0)}, {Vector3(1.1, 0, 0), Vector3(1.3, 4, 0)}});
  for (int row = 0; row < 4; ++row) {
    options.cuts.push_back({2 + 5 * row, 2 + 5 * (row + 1)});
  }
  const auto parts = [](const Vector3& p) {
    return 4 * (p.x() > 2) + 2 * (leftOf({0, 1.3, 0}, {4, 2.9, 0}, p) > 0) +
           (leftOf({1.1, 0, 0}, {1.3, 4, 0}, p) > 0);
  };
  expectNothingCrosses(surface, scatterJittered(surface, 3, 3), scatterJittered(surface, 6, 5),
                       options, parts);
}

TEST(SlowCurveCuts, KeepNothingApartWhereTheyAreClosedInNothing) {
  // a stitch in the middle changes only what lies behind it
  const LimitSurface surface = flatSheet(6);
  const Locations guides = scatterJittered(surface, 1, 3), at = scatterJittered(surface, 3, 5);
  const GuideWeights without = guideWeights(surface, guides, at, cutBy({}, 1));
  const GuideWeights with =
      guideWeights(surface, guides, at, cutBy({{Vector3(3, 3, 0), Vector3(3.2, 3.1, 0)}}, 1));
  int changed = 0;
  for (std::size_t i = 0; i < with.guide.size(); ++i) {
    ASSERT_GE(with.guide[i], 0);
    EXPECT_GE(with.distance[i], without.distance[i] * (1 - 1e-3) - 2e-4);
    changed += with.distance[i] > without.distance[i] * 1.001 + 2e-4;
  }
  EXPECT_LT(changed, static_cast<int>(with.guide.size()) / 20);
}

TEST(SlowCurveCuts, RandomScribblesHangTogetherOrNotAsCurvesDo) {
  // every scribble ends with a line from border to border, which the rest must not open
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.5, 6.5);
  const LimitSurface surface = flatSheet(6);
  const Locations guides = scatterJittered(surface, 1, 3), at = scatterJittered(surface, 3, 5);
  for (int round = 0; round < 3; ++round) {
    Curve scribble;
    for (int i = 0; i < 6; ++i) {
      scribble.emplace_back(coordinate(random), coordinate(random), 0);
    }
    const Vector3 a(coordinate(random), -0.5, 0), b(coordinate(random), 6.5, 0);
    const GuideOptions options = cutBy({scribble, {a, b}, scribble}, 2);
    const GuideWeights found = guideWeights(surface, guides, at, options);
    const Points p = surface.evaluate(at).position, g = surface.evaluate(guides).position;
    for (std::size_t i = 0; i < found.guide.size(); ++i) {
      if (found.guide[i] >= 0) {
        const Vector3 here = p.row(static_cast<Eigen::Index>(i / 2)), there = g.row(found.guide[i]);
        EXPECT_EQ(leftOf(a, b, here) > 0, leftOf(a, b, there) > 0) << here << "\n" << there;
      }
    }
  }
}

TEST(CurveCuts, GoOnOverExtraordinaryVerticesAndCreases) {
  // a plane through a torus: two closed curves keep its halves apart
  const LimitSurface surface = limitSurface(torus(16, 8));
  const Points all = surface.evaluate(scatterJittered(surface, 4, 1)).position;
  const double outer = all.col(0).maxCoeff(), tube = all.col(2).maxCoeff();
  std::vector<Curve> curves;
  for (const double side : {-1., 1.}) {
    Curve ring;
    for (int i = 0; i <= 48; ++i) {
      const double turn = 2 * kPi<double> * i / 48;
      ring.emplace_back(side * (outer - tube + tube * std::cos(turn)), 0.03, tube * std::sin(turn));
    }
    ring.back() = ring.front();
    curves.push_back(ring);
  }
  Locations clear;
  for (const Location& place : scatterJittered(surface, 4, 5)) {
    if (std::abs(surface.evaluate(Locations{place}).position(0, 1) - 0.03) > 1e-2) {
      clear.push_back(place);
    }
  }
  expectNothingCrosses(surface, scatterJittered(surface, 1, 3), clear, cutBy(curves),
                       [](const Vector3& p) { return p.y() > 0.03; });
}

TEST(CurveCuts, DoNotDependOnThreads) {
  const LimitSurface surface = flatSheet(3);
  const Locations guides = scatterJittered(surface, 1, 3), at = scatterJittered(surface, 8, 5);
  GuideOptions options = cutBy({{Vector3(-1, 1.2, 0), Vector3(2, 2, 0), Vector3(2.5, -1, 0)}});
  options.threads = 1;
  const GuideWeights one = guideWeights(surface, guides, at, options);
  options.threads = 2;
  const GuideWeights two = guideWeights(surface, guides, at, options);
  EXPECT_EQ(one.guide, two.guide);
  EXPECT_EQ(one.weight, two.weight);
  EXPECT_EQ(one.distance, two.distance);
}

TEST(CurveCuts, NameWhatIsWrong) {
  const LimitSurface surface = flatSheet(2);
  const Locations at = {{0, 0.5, 0.5}};
  GuideOptions options = cutBy({{Vector3(0, 0, 0), Vector3(1, NAN, 0)}});
  expectThrow<std::invalid_argument>([&] { guideWeights(surface, at, at, options); },
                                     {"row 1", "not finite"});
  options.cut_curves.points(1, 1) = 1;
  options.cut_curves.offsets = {0, 3};
  expectThrow<std::invalid_argument>([&] { guideWeights(surface, at, at, options); },
                                     {"cut_offsets", "rows of cut_points, 2"});
}

TEST(CurveCuts, OfOnePointOrNoneCutNothing) {
  const LimitSurface surface = flatSheet(3);
  const Locations guides = scatterJittered(surface, 1, 3), at = scatterJittered(surface, 3, 5);
  const GuideWeights plain = guideWeights(surface, guides, at);
  for (const Polylines& none : {polylines({}), polylines({{}}), polylines({{Vector3(1, 1, 0)}})}) {
    GuideOptions options;
    options.cut_curves = none;
    EXPECT_EQ(guideWeights(surface, guides, at, options).distance, plain.distance);
  }
}

}  // namespace
}  // namespace limitsurf::test
