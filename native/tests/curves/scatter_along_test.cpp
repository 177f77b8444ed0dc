// SPDX-License-Identifier: Apache-2.0
//
// Locations along curves: numbers, distances, randomness and directions.
#include "limitsurf/curves/scatter_along.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

AlongOptions byCount(std::int64_t count) {
  AlongOptions options;
  options.count = count;
  return options;
}

std::vector<double> arcsOf(const AlongCurves& along, int curve) {
  std::vector<double> arcs;
  for (std::size_t i = 0; i < along.arc.size(); ++i) {
    if (along.curve[i] == curve) {
      arcs.push_back(along.arc[i]);
    }
  }
  return arcs;
}

TEST(ScatterAlong, NeighboursAreEquallyFarApart) {
  const LimitSurface surface = limitSurface(perturbed(gridWithHoles(6, 5, {8, 21}), 0.2, 2));
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  const AlongCurves along = scatterAlong(surface, curves, byCount(100));
  ASSERT_EQ(along.at.size(), 100u);
  double total = 0;
  for (int curve = 0; curve < curves.count(); ++curve) {
    total += curves.length(curve);
  }
  for (int curve = 0; curve < curves.count(); ++curve) {
    const std::vector<double> arcs = arcsOf(along, curve);
    const double length = curves.length(curve), gap = length / static_cast<double>(arcs.size());
    EXPECT_LT(std::abs(static_cast<double>(arcs.size()) - 100 * length / total), 1);
    for (std::size_t i = 1; i < arcs.size(); ++i) {
      EXPECT_NEAR(arcs[i] - arcs[i - 1], gap, 1e-12 * length);
    }
    EXPECT_LT(arcs.front(), gap);
  }
}

TEST(ScatterAlong, SpacingDividesEachCurve) {
  const LimitSurface surface = limitSurface(fullGrid(4, 4));
  const EdgeCurves curves(surface, {{6, 7}, {7, 8}, {16, 17}});
  AlongOptions options;
  options.spacing = 0.3;
  const AlongCurves along = scatterAlong(surface, curves, options);
  for (int curve = 0; curve < curves.count(); ++curve) {
    EXPECT_EQ(static_cast<double>(arcsOf(along, curve).size()),
              std::round(curves.length(curve) / 0.3));
  }
}

TEST(ScatterAlong, JitterStaysWithinItsBounds) {
  const LimitSurface surface = limitSurface(cross());
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  AlongOptions even = byCount(2000), uneven = even;
  uneven.jitter = 0.6;
  const AlongCurves a = scatterAlong(surface, curves, even);
  const AlongCurves b = scatterAlong(surface, curves, uneven);
  const double length = curves.length(0), gap = length / 2000;
  double sum = 0, most = 0;
  for (std::size_t i = 0; i < a.arc.size(); ++i) {
    const double moved = std::remainder(b.arc[i] - a.arc[i], length) / gap;
    sum += moved;
    most = std::max(most, std::abs(moved));
  }
  EXPECT_LE(most, 0.3 + 1e-9);
  EXPECT_GT(most, 0.29);
  EXPECT_LT(std::abs(sum) / 2000, 4 * 0.6 / std::sqrt(12. * 2000));
}

TEST(ScatterAlong, OpenCurvesKeepTheirLocations) {
  const LimitSurface surface = limitSurface(fullGrid(3, 3));
  const EdgeCurves curves(surface, {{4, 5}, {5, 6}});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    AlongOptions options = byCount(4);
    options.jitter = 1;
    options.seed = seed;
    const std::vector<double> arcs = arcsOf(scatterAlong(surface, curves, options), 0);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      EXPECT_GE(arcs[i], i == 0 ? 0 : arcs[i - 1]);
      EXPECT_LE(arcs[i], curves.length(0));
    }
  }
}

TEST(ScatterAlong, DirectionsAreTangentialAndOrthonormal) {
  const LimitSurface surface = limitSurface(mixture(7));
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  const AlongCurves along = scatterAlong(surface, curves, byCount(300));
  const auto frames = surface.frames(along.at);
  const Evaluation here = surface.evaluate(along.at, Derivatives::first);
  for (Eigen::Index i = 0; i < 300; ++i) {
    const Vector3 normal(frames(i, 2), frames(i, 5), frames(i, 8));
    const Vector3 tangent = along.tangent.row(i), outward = along.outward.row(i);
    EXPECT_NEAR(tangent.norm(), 1, 1e-12);
    EXPECT_NEAR(outward.norm(), 1, 1e-12);
    EXPECT_LT(std::abs(tangent.dot(normal)) + std::abs(outward.dot(normal)), 1e-12);
    EXPECT_LT(std::abs(tangent.dot(outward)), 1e-12);
    // Inwards u or v grows or shrinks; the derivative into the face points against outward.
    const Location& at = along.at[static_cast<std::size_t>(i)];
    const Vector3 du = here.du.row(i), dv = here.dv.row(i);
    const Vector3 into = at.v == 0 ? dv : at.u == 1 ? Vector3(-du) : at.v == 1 ? Vector3(-dv) : du;
    EXPECT_LT(into.dot(outward), 0) << describe(at);
  }
}

/// The distances of all locations in a plane from the curves, by many points of these.
std::vector<double> distancesInPlane(const LimitSurface& surface, const EdgeCurves& curves,
                                     const AlongCurves& along) {
  std::vector<std::int64_t> curve;
  std::vector<double> arc;
  for (int i = 0; i < curves.count(); ++i) {
    for (int k = 0; k <= 3000; ++k) {
      curve.push_back(i);
      arc.push_back(curves.length(i) * (k / 3000.));
    }
  }
  const Points dense = surface.evaluate(pointsAlong(surface, curves, curve, arc).at).position;
  const Points at = surface.evaluate(along.at).position;
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    distances.push_back((dense.rowwise() - at.row(i)).rowwise().norm().minCoeff());
  }
  return distances;
}

TEST(ScatterAlong, RowsInAPlaneKeepTheirDistanceAndEndWhereTheyMeet) {
  std::vector<int> holes;
  for (const int row : {4, 5}) {
    holes.push_back(12 * row + 5);
    holes.push_back(12 * row + 6);
  }
  Cage corners = fullGrid(12, 12);
  corners.options.boundary = Boundary::corners;
  for (const Cage& cage : {gridWithHoles(12, 12, holes), corners}) {
    const LimitSurface surface = limitSurface(cage);
    const EdgeCurves curves(surface, EdgeChoice::boundary);
    AlongOptions options = byCount(400);
    options.rows = 8;
    options.row_distance = 0.7;
    const AlongCurves along = scatterAlong(surface, curves, options);
    const std::vector<double> distance = distancesInPlane(surface, curves, along);
    std::vector<std::int64_t> count(8, 0);
    for (std::size_t i = 0; i < along.at.size(); ++i) {
      const int row = along.row[i];
      ++count[static_cast<std::size_t>(row)];
      // The points of the curves are 0.016 apart.
      EXPECT_NEAR(distance[i], 0.7 * row, row == 0 ? 0.009 : kRowError * 0.7 * row + 2e-4);
    }
    for (std::size_t row = 0; row < 8; ++row) {
      EXPECT_EQ(count[row] + along.ended[row], 400);
    }
    EXPECT_EQ(count[0], 400);
    EXPECT_GT(along.ended[1], 0);
    EXPECT_GT(count[3], 0);
  }
}

TEST(ScatterAlong, RowsEndBesideEndsAndCornersOfOtherCurves) {
  // A line and, above it, a curve with an end and one with a corner that point to it. On triangles
  // a geodesic towards a vertex does not run along edges, so that it passes the vertex.
  const auto vertex = [](int x, int y) { return std::int64_t{9} * y + x; };
  std::vector<std::pair<std::int64_t, std::int64_t>> edges;
  for (int x = 0; x < 8; ++x) {
    edges.emplace_back(vertex(x, 2), vertex(x + 1, 2));
  }
  edges.emplace_back(vertex(2, 4), vertex(2, 5));
  edges.emplace_back(vertex(6, 4), vertex(7, 4));
  edges.emplace_back(vertex(6, 4), vertex(6, 5));
  const Cage bent = inTriangles(fullGrid(8, 8));
  for (const bool moved : {false, true}) {
    Cage cage = bent;
    if (moved) {
      for (int v = 0; v < cage.vertexCount(); ++v) {
        cage.positions(v, 0) += 0.2 * std::sin(3. * v);
        cage.positions(v, 1) += 0.2 * std::cos(5. * v);
      }
    }
    const LimitSurface surface = limitSurface(cage);
    const EdgeCurves curves(surface, edges);
    for (const CurveSide side : {CurveSide::left, CurveSide::right}) {
      AlongOptions options = byCount(300);
      options.rows = 5;
      options.row_distance = 0.5;
      options.side = side;
      const AlongCurves along = scatterAlong(surface, curves, options);
      const std::vector<double> distance = distancesInPlane(surface, curves, along);
      for (std::size_t i = 0; i < along.at.size(); ++i) {
        // The points of the curves are at most 0.003 apart.
        EXPECT_NEAR(distance[i], 0.5 * along.row[i], kRowError * 0.5 * along.row[i] + 2e-3);
      }
      EXPECT_GT(along.at.size(), 800U);
    }
  }
}

TEST(ScatterAlong, RowsEndBesideSmallHoles) {
  // Seen from afar, the nearest place of a small hole is often one of its extraordinary vertices.
  std::vector<int> holes;
  for (const int row : {4, 12}) {
    holes.push_back(20 * row + 4);
    holes.push_back(20 * row + 12);
  }
  const LimitSurface surface = limitSurface(gridWithHoles(20, 20, holes));
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  AlongOptions options = byCount(800);
  options.rows = 6;
  options.row_distance = 1;
  const AlongCurves along = scatterAlong(surface, curves, options);
  const std::vector<double> distance = distancesInPlane(surface, curves, along);
  for (std::size_t i = 0; i < along.at.size(); ++i) {
    EXPECT_NEAR(distance[i], along.row[i], along.row[i] == 0 ? 0.015 : kRowError * along.row[i]);
  }
  EXPECT_GT(along.at.size(), 2000U);
}

TEST(ScatterAlong, RowsOfASquareAreAsLongAsItsOffsets) {
  Cage square = fullGrid(12, 12);
  square.options.boundary = Boundary::corners;
  const LimitSurface surface = limitSurface(square);
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  AlongOptions options = byCount(4800);
  options.rows = 7;
  options.row_distance = 0.9;
  const AlongCurves along = scatterAlong(surface, curves, options);
  for (int row = 0; row < 7; ++row) {
    // Of each side so much is left: none of it may be missing, and at each end at most what the
    // bound allows may be too much.
    const double left = 400 * (12 - 2 * 0.9 * row), more = 800 * 0.9 * row * 1.1 * kRowError;
    const auto found = 4800 - along.ended[static_cast<std::size_t>(row)];
    EXPECT_GE(static_cast<double>(found), left - 10) << row;
    EXPECT_LE(static_cast<double>(found), left + more + 10) << row;
  }
}

TEST(ScatterAlong, RowsFollowThePlaneAroundAnEdge) {
  // A lip: two sheets close to each other in space, which are joined far away.
  Cage cage = fullGrid(12, 4);
  for (int v = 0; v < cage.vertexCount(); ++v) {
    const double x = cage.positions(v, 0);
    if (x > 6) {
      cage.positions(v, 0) = 12 - x;
      cage.positions(v, 2) = 0.2;
    }
  }
  const LimitSurface surface = limitSurface(cage);
  // The edges at x = 1 of the lower sheet: those above them on the upper sheet are 0.2 away.
  std::vector<std::pair<std::int64_t, std::int64_t>> edges;
  for (int j = 0; j < 4; ++j) {
    edges.emplace_back(13 * j + 1, 13 * (j + 1) + 1);
    edges.emplace_back(13 * j + 11, 13 * (j + 1) + 11);
  }
  const EdgeCurves curves(surface, edges);
  AlongOptions options = byCount(80);
  options.rows = 2;
  options.row_distance = 0.8;
  const AlongCurves along = scatterAlong(surface, curves, options);
  // Only where a geodesic leaves the sheet's sides.
  EXPECT_LE(along.ended[1], 2);
}

TEST(ScatterAlong, DependsOnTheSeedAlone) {
  const LimitSurface surface = limitSurface(mixture(3));
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  AlongOptions options = byCount(1000);
  options.jitter = 0.5;
  options.seed = 7;
  options.rows = 3;
  options.row_distance = 0.02 * diagonal(surface.positions());
  const AlongCurves one = scatterAlong(surface, curves, options, 1);
  const AlongCurves many = scatterAlong(surface, curves, options, 3);
  EXPECT_EQ(one.arc, many.arc);
  EXPECT_EQ(one.tangent, many.tangent);
  EXPECT_EQ(one.outward, many.outward);
  options.seed = 8;
  EXPECT_NE(one.arc, scatterAlong(surface, curves, options).arc);
}

TEST(ScatterAlong, RefusesWhatHasNoMeaning) {
  const LimitSurface surface = limitSurface(cross()), closed = limitSurface(cube());
  const EdgeCurves curves(surface, EdgeChoice::boundary);
  const EdgeCurves none(closed, EdgeChoice::boundary);
  const auto refuses = [&](const AlongOptions& options) {
    EXPECT_THROW(scatterAlong(surface, curves, options), std::invalid_argument);
  };
  refuses({});
  refuses(byCount(-1));
  AlongOptions options = byCount(5);
  options.spacing = 1;
  refuses(options);
  options = byCount(5);
  options.jitter = 1.5;
  refuses(options);
  options = byCount(5);
  options.phase = std::nan("");
  refuses(options);
  options = {};
  options.spacing = 0;
  refuses(options);
  options = byCount(5);
  options.rows = 0;
  refuses(options);
  options.rows = 2;
  refuses(options);
  options.row_distance = 1e-300;
  refuses(options);
  options = {};
  options.spacing = 1e-300;
  refuses(options);
  EXPECT_THROW(scatterAlong(closed, none, byCount(1)), std::invalid_argument);
  EXPECT_TRUE(scatterAlong(closed, none, byCount(0)).at.empty());
  EXPECT_THROW(pointsAlong(surface, curves, {1}, {0}), std::invalid_argument);
  EXPECT_THROW(pointsAlong(surface, curves, {0}, {-1e-9}), std::invalid_argument);
  EXPECT_THROW(pointsAlong(surface, curves, {0}, {curves.length(0) * 1.001}),
               std::invalid_argument);
}

}  // namespace
}  // namespace limitsurf::test
