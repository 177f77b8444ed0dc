// SPDX-License-Identifier: Apache-2.0
//
// Directions of curves, continued over surfaces on which the field that changes least is known.
#include "limitsurf/flow/curve_directions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include "limitsurf/flow/tangent_planes.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/truth/decompositions.h"

namespace limitsurf::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A sheet of `columns` x `rows` quads with pinned corners: the limit surface of a flat one is the
/// whole rectangle. `place` maps (x, y) to space.
template <typename Place>
LimitSurface sheet(int columns, int rows, const Place& place) {
  Cage cage;
  cage.positions.resize((columns + 1) * (rows + 1), 3);
  cage.options.boundary = Boundary::corners;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const int first = j * (columns + 1) + i;
      cage.positions.row(first) = place(i, j);
      if (i < columns && j < rows) {
        cage.faces.push_back({first, first + 1, first + columns + 2, first + columns + 1});
      }
    }
  }
  return limitSurface(cage);
}

std::vector<Location> everywhere(const LimitSurface& surface) {
  Random random(7);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (int i = 0; i < 5; ++i) {
      at.push_back({face, random.uniform(), random.uniform()});
    }
  }
  return at;
}

Polylines curves(std::initializer_list<std::pair<Vector3, Vector3>> lines) {
  Polylines result{Points(2 * static_cast<Eigen::Index>(lines.size()), 3), {0}};
  Eigen::Index row = 0;
  for (const auto& [from, to] : lines) {
    result.points.row(row++) = from;
    result.points.row(row++) = to;
    result.offsets.push_back(row);
  }
  return result;
}

Vector3 flat(int i, int j) { return {double(i), double(j), 0}; }

TEST(TangentPlanes, BasesArePerpendicularAndTurnByTheSmallestRotation) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 from = Vector3::NullaryExpr([&] { return random.uniform() - 0.5; }).normalized();
    const Vector3 to = Vector3::NullaryExpr([&] { return random.uniform() - 0.5; }).normalized();
    const PlaneBasis basis = planeBasis(from);
    EXPECT_LT((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), 1e-14);
    EXPECT_LT((basis.transpose() * from).norm(), 1e-14);
    const Vector3 near = from.dot(to) < 0 ? Vector3(-from) : from;
    const Eigen::Matrix3d rotation = rotationBetween(near, to);
    EXPECT_LT((turned(basis, from, to) - rotation * basis).norm(), 1e-12);
    EXPECT_LT((turned(basis, -from, to) - rotation * basis).norm(), 1e-12);
  }
}

TEST(CurveDirections, OneStraightCurveGivesItsDirectionToAFlatSurface) {
  const LimitSurface surface = sheet(5, 4, flat);
  const auto at = everywhere(surface);
  const Vector3 along = Vector3(2, 1, 0).normalized();
  // the curve floats above the surface, slanting
  const Points found = curveDirections(surface, curves({{{1, 1, 0.5}, {3, 2, 0.9}}}), at);
  for (Eigen::Index row = 0; row < found.rows(); ++row) {
    EXPECT_LT((found.row(row).transpose() - along).norm(), 1e-7);
  }
}

TEST(CurveDirections, VectorsChangeLinearlyBetweenTwoLinesAcrossAStrip) {
  const LimitSurface surface = sheet(8, 3, flat);
  const auto at = everywhere(surface);
  const Vector3 left(0, 1, 0);
  // the curve at x = 2 is straight; that at x = 6 consists of pieces that cross the line at 45
  // degrees
  Polylines zigzag{Points(2 + 2 * 300, 3), {0, 2}};
  zigzag.points.row(0) = Vector3(2, 0, 0);
  zigzag.points.row(1) = Vector3(2, 3, 0);
  const double step = 3. / 300;
  for (int i = 0; i < 300; ++i) {
    zigzag.points.row(2 + 2 * i) = Vector3(6 - step / 2, i * step, 0);
    zigzag.points.row(3 + 2 * i) = Vector3(6 + step / 2, (i + 1) * step, 0);
    zigzag.offsets.push_back(4 + 2 * i);
  }
  const Vector3 diagonal = Vector3(1, 1, 0).normalized();
  const Points found = curveDirections(surface, zigzag, at);
  const Points position = surface.evaluate(at).position;
  for (Eigen::Index row = 0; row < found.rows(); ++row) {
    const double part = std::clamp((position(row, 0) - 2) / 4, 0., 1.);
    const Vector3 expected = ((1 - part) * left + part * diagonal).normalized();
    EXPECT_LT((found.row(row).transpose() - expected).norm(), 2e-3) << position.row(row);
  }
}

TEST(CurveDirections, FollowTheSurfaceAroundACylinder) {
  // a strip bent to three quarters of a cylinder; the field is parallel along the surface
  const double turn = 1.5 * kPi / 16;
  const LimitSurface surface = sheet(16, 4, [&](int i, int j) {
    return Vector3(std::cos(turn * i), std::sin(turn * i), 0.5 * j);
  });
  const auto at = everywhere(surface);
  const Evaluation e = surface.evaluate(at, Derivatives::first, true);
  const Points along_axis = curveDirections(surface, curves({{{1, 0, 0.5}, {1, 0, 1.5}}}), at);
  const Points around = curveDirections(surface,
                                        curves({{{std::cos(turn * 2), std::sin(turn * 2), 1},
                                                 {std::cos(turn * 3), std::sin(turn * 3), 1}}}),
                                        at);
  for (Eigen::Index row = 0; row < e.position.rows(); ++row) {
    EXPECT_LT((along_axis.row(row).transpose() - Vector3::UnitZ()).norm(), 1e-6);
    const Vector3 normal = e.normal.row(row);
    const Vector3 expected = Vector3::UnitZ().cross(normal);
    EXPECT_LT((around.row(row).transpose() - expected).norm(), 1e-4);
  }
}

TEST(CurveDirections, DoNotJumpAcrossAGap) {
  // two sheets above each other that hang together on one side only, like two lips
  const LimitSurface surface =
      sheet(8, 4, [](int i, int j) { return i < 4 ? Vector3(i, j, 0) : Vector3(8 - i, j, 0.2); });
  const auto at = everywhere(surface);
  const Points position = surface.evaluate(at).position;
  // curves on both sheets, close to each other in space, that run opposite ways
  const Points found = curveDirections(
      surface, curves({{{1, 0, -0.1}, {1, 4, -0.1}}, {{1, 4, 0.3}, {1, 0, 0.3}}}), at);
  for (Eigen::Index row = 0; row < found.rows(); ++row) {
    if (position(row, 0) < 2) {
      const bool lower = position(row, 2) < 0.1;
      EXPECT_LT((found.row(row).transpose() - Vector3(0, lower ? 1 : -1, 0)).norm(), 1e-2);
    }
  }
}

TEST(SlowCurveDirections, AreTangentUnitVectorsOnAnyMeshAndZeroWhereNoCurveLeads) {
  for (const Cage& cage : {mixture(1), cross()}) {
    const LimitSurface surface = limitSurface(cage);
    const auto at = everywhere(surface);
    const Evaluation e = surface.evaluate(at, Derivatives::first, true);
    const Polylines line = curves({{e.position.row(0), e.position.row(e.position.rows() / 2)}});
    const Points found = curveDirections(surface, line, at);
    const Points again = curveDirections(surface, line, at, 1);
    EXPECT_EQ(found, again);
    for (Eigen::Index row = 0; row < found.rows(); ++row) {
      const double length = found.row(row).norm();
      EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-12);
      EXPECT_LT(std::abs(found.row(row).dot(e.normal.row(row))), 1e-10);
    }
  }
}

TEST(CurveDirections, AreZeroOnPartsWithoutACurve) {
  Cage two = cross();
  const auto vertices = two.positions.rows();
  Points positions(2 * vertices, 3);
  positions << two.positions, two.positions.rowwise() + Eigen::RowVector3d(100, 0, 0);
  const std::size_t faces = two.faces.size();
  two.positions = positions;
  for (std::size_t i = 0; i < faces; ++i) {
    auto face = two.faces[i];
    for (auto& vertex : face) vertex += static_cast<int>(vertices);
    two.faces.push_back(face);
  }
  const LimitSurface surface = limitSurface(two);
  const auto at = everywhere(surface);
  const Points position = surface.evaluate(at).position;
  const Points found = curveDirections(
      surface, curves({{position.row(0), Vector3(position.row(0)) + Vector3(0.3, 0.2, 0)}}), at);
  for (Eigen::Index row = 0; row < found.rows(); ++row) {
    EXPECT_NEAR(found.row(row).norm(), position(row, 0) > 50 ? 0 : 1, 1e-12);
  }
}

TEST(CurveDirections, RefuseCurvesThatSayNothing) {
  const LimitSurface surface = sheet(2, 2, flat);
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  const auto refuse = [&](const Polylines& lines) {
    EXPECT_THROW(curveDirections(surface, lines, at), std::invalid_argument);
  };
  refuse({Points(0, 3), {0}});
  refuse({Points(0, 3), {}});
  refuse(curves({{{1, 1, 0}, {1, 1, 2}}}));  // along the normal
  refuse(curves({{{1, 1, 0}, {1, 1, 0}}}));  // without a length
  refuse(curves({{{1, 1, 0}, {1, NAN, 0}}}));
  Polylines wrong = curves({{{0, 0, 0}, {1, 1, 0}}});
  wrong.offsets = {0, 1};
  refuse(wrong);
  wrong.offsets = {0, 3, 2};
  refuse(wrong);
}

}  // namespace
}  // namespace limitsurf::test
