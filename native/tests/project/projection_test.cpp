// SPDX-License-Identifier: Apache-2.0
//
// Projectors and projections on shapes with known formulas.
#include "limitsurf/project/projection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/image/blend.h"
#include "limitsurf/project/box_projectors.h"
#include "limitsurf/project/projector.h"
#include "limitsurf/uv/texel_places.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

constexpr double kNear = 0.5, kFar = 40;

/// The projection of a camera that looks along its own -z.
Eigen::Matrix4d perspective(double half_width) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = m(1, 1) = 1 / half_width;
  m(2, 2) = -(kFar + kNear) / (kFar - kNear);
  m(2, 3) = -2 * kFar * kNear / (kFar - kNear);
  m(3, 2) = -1;
  return m;
}

Eigen::Matrix4d orthographic(double half_width) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m(0, 0) = m(1, 1) = 1 / half_width;
  m(2, 2) = -2 / (kFar - kNear);
  m(2, 3) = -(kFar + kNear) / (kFar - kNear);
  return m;
}

/// The camera's transformation in the world: an arbitrary rotation and translation.
Eigen::Isometry3d somewhere(Random& random, const Vector3& eye) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                                     random.uniform(-1, 1), random.uniform(-1, 1))
                                      .normalized();
  return Eigen::Translation3d(eye) * turn;
}

/// The map whose values are (x, y) of the vertices.
SurfaceData flatMap(const LimitSurface& surface) {
  return surface.vertexData(surface.positions().leftCols<2>());
}

/// A grid of 8 x 8 around (0, 0) whose surface, in the middle, is exactly the parabolic cylinder
/// z = bend x^2 / 2.
LimitSurface parabola(double bend) {
  Cage cage = grid(8, 8);
  cage.positions.leftCols<2>().array() -= 4;
  cage.positions.col(2) = bend / 2 * (cage.positions.col(0).array().square() - 1. / 3);
  return limitSurface(cage);
}

/// Locations on that grid's inner faces.
std::vector<Location> inside(int count, Random& random) {
  std::vector<Location> at;
  for (int i = 0; i < count; ++i) {
    const int face = 8 * (2 + random.below(4)) + 2 + random.below(4);
    at.push_back({face, random.uniform(), random.uniform()});
  }
  return at;
}

TEST(Projector, FindsTheEye) {
  Random random(1);
  const LimitSurface surface = limitSurface(cube());
  for (int i = 0; i < 200; ++i) {
    const double away = std::pow(10., random.uniform(-2, 6));
    const Vector3 eye = random.vector(away);
    const Eigen::Isometry3d place = somewhere(random, eye);
    const Projector projector(perspective(0.4) * place.inverse().matrix(), surface);
    ASSERT_TRUE(projector.hasEye());
    EXPECT_LE((projector.eye() - eye).norm(), 1e-13 * (1 + away * away));

    const Vector3 point = place * (Vector3(0.1, -0.2, -1) * random.uniform(0.6, 30));
    const Projector::View view = projector.see(point);
    EXPECT_TRUE(view.in_front);
    EXPECT_NEAR(projector.distanceToEye(point), (eye - point).norm(), 1e-9 * (1 + away));
    if (away < 100) {
      EXPECT_NEAR((view.to_eye - (eye - point).normalized()).norm(), 0, 1e-9);
      const double near = projector.distanceToPlane(point, view.to_eye, -1);
      EXPECT_NEAR(projector.see(point + near * view.to_eye).depth, -1, 1e-9);
    }
    EXPECT_FALSE(projector.see(place * Vector3(0.1, 0.1, 1)).in_front);
  }
}

TEST(Projector, ParallelLinesOfSightComeFromTheNearSide) {
  Random random(2);
  const LimitSurface surface = limitSurface(cube());
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d place = somewhere(random, random.vector(10));
    const Projector projector(orthographic(2) * place.inverse().matrix(), surface);
    ASSERT_FALSE(projector.hasEye());
    const Vector3 backwards = place.linear() * Vector3::UnitZ();
    const Vector3 point = place * Vector3(0.3, 0.4, -7);
    const Projector::View view = projector.see(point);
    EXPECT_LE((view.to_eye - backwards).norm(), 1e-14);
    EXPECT_TRUE(std::isinf(projector.distanceToEye(point)));
    EXPECT_NEAR(projector.distanceToPlane(point, view.to_eye, -1), 7 - kNear, 1e-12);
    EXPECT_NEAR(view.st[0], 0.5 + 0.3 / 4, 1e-14);
    EXPECT_NEAR(view.st[1], 0.5 + 0.4 / 4, 1e-14);
  }
}

TEST(Projector, DerivativesAreThoseOfPlaces) {
  Random random(3);
  const LimitSurface surface = limitSurface(cube());
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix4d lens = i % 2 == 0 ? perspective(0.6) : orthographic(3);
    const Eigen::Isometry3d place = somewhere(random, random.vector(2));
    const Projector projector(lens * place.inverse().matrix(), surface);
    const Vector3 point = place * Vector3(random.uniform(-1, 1), random.uniform(-1, 1), -3);
    const auto derivatives = projector.see(point).st_by_point;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 step = 1e-5 * Vector3::Unit(axis);
      const Eigen::Vector2d difference =
          (projector.see(point + step).st - projector.see(point - step).st) / 2e-5;
      EXPECT_LE((derivatives.col(axis) - difference).norm(), 1e-9);
    }
  }
}

TEST(Projection, OfAPlaneFromAbove) {
  const LimitSurface surface = limitSurface(grid(6, 4));
  const SurfaceData map = flatMap(surface);
  const SurfaceSearch search(surface);
  Random random(4);
  std::vector<Location> at;
  for (int i = 0; i < 200; ++i)
    at.push_back({random.below(24), random.uniform(), random.uniform()});
  const Evaluation e = surface.evaluate(at);
  const Vector3 eye(2.5, 1.7, 3);
  Eigen::Matrix4d from_world = Eigen::Matrix4d::Identity();
  from_world.topRightCorner<3, 1>() = -eye;
  const double half_width = 0.45;
  ProjectOptions options;
  options.facing_start = 0.1;
  options.facing_end = 0.4;
  const Projection seen = project(surface, map, at, perspective(half_width) * from_world,
                                  {0.01, 0.02}, &search, options);
  const double scale = 1 / (2 * half_width * eye[2]);
  for (Eigen::Index i = 0; i < seen.weight.size(); ++i) {
    const Eigen::Vector2d aside = (e.position.row(i).transpose() - eye).head<2>();
    EXPECT_NEAR(seen.st(i, 0), 0.5 + aside[0] * scale, 1e-14);
    EXPECT_NEAR(seen.st(i, 1), 0.5 + aside[1] * scale, 1e-14);
    const Eigen::RowVector4d footprint(0.01 * scale, 0, 0, 0.02 * scale);
    EXPECT_LE((seen.footprint.row(i) - footprint).norm(), 1e-14);
    const double angle = std::atan2(aside.norm(), eye[2]);
    const double fall = std::clamp((angle - 0.1) / 0.3, 0., 1.);
    EXPECT_NEAR(seen.weight[i], 1 - fall * fall * (3 - 2 * fall), 1e-12);
  }
}

TEST(Projection, AlongTheNormalsOfAParabola) {
  const double bend = 0.2, height = 1.3;
  const LimitSurface surface = parabola(bend);
  Cage ceiling = grid(8, 8);
  ceiling.positions.leftCols<2>().array() -= 4;
  ceiling.positions.col(2).setConstant(height);
  const LimitSurface source = limitSurface(ceiling);
  const SurfaceData map = flatMap(surface), source_map = flatMap(source);
  const SurfaceSearch search(source);
  Random random(5);
  const std::vector<Location> at = inside(300, random);
  const Evaluation e = surface.evaluate(at);
  const Projection seen =
      projectAlongNormals(surface, map, at, source, source_map, search, {0.01, 0.02});
  for (Eigen::Index i = 0; i < seen.weight.size(); ++i) {
    const double x = e.position(i, 0), y = e.position(i, 1);
    ASSERT_NEAR(e.position(i, 2), bend / 2 * x * x, 1e-13);
    // The ray leads from (x, bend x^2 / 2) along (-bend x, 1) up to the ceiling.
    EXPECT_NEAR(seen.st(i, 0), x - bend * x * (height - bend / 2 * x * x), 1e-11);
    EXPECT_NEAR(seen.st(i, 1), y, 1e-11);
    const double widened = 1 - bend * height + 1.5 * bend * bend * x * x;
    const Eigen::RowVector4d footprint(0.01 * widened, 0, 0, 0.02);
    EXPECT_LE((seen.footprint.row(i) - footprint).norm(), 1e-12);
    EXPECT_EQ(seen.weight[i], 1);
  }
}

TEST(Projection, StepsAsideWhereThereAreNoDerivatives) {
  for (int faces : {3, 5, 8}) {
    const LimitSurface surface = limitSurface(fan(faces, true, 1));
    const SurfaceData map = flatMap(surface);
    const std::vector<Location> vertex = {{0, 0, 0}}, beside = {steppedAside(vertex[0])};
    const TexelPlaces here = texelPlaces(surface, map, vertex, {0.01, 0.01}, true, 1),
                      there = texelPlaces(surface, map, beside, {0.01, 0.01}, true, 1);
    EXPECT_TRUE(here.along_x == there.along_x);
    EXPECT_TRUE(here.normal_along_y == there.normal_along_y);
    EXPECT_TRUE(here.along_x.allFinite());
    EXPECT_TRUE(here.position == surface.evaluate(vertex).position);
    EXPECT_NEAR(here.normal.norm(), 1, 1e-12);
    // The map's x is that of space.
    EXPECT_NEAR(here.along_x(0, 0), 0.01, 1e-10);
    EXPECT_NEAR(here.along_x(0, 1), 0, 1e-10);
  }
}

TEST(Projection, SaysWhatIsWrong) {
  const LimitSurface surface = limitSurface(grid(2, 2));
  const SurfaceData map = flatMap(surface);
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  Eigen::Matrix4d matrix = orthographic(1);
  matrix.row(1) = matrix.row(0);
  const auto with = [&](const Eigen::Matrix4d& projector) {
    project(surface, map, at, projector, {1, 1}, nullptr);
  };
  expectThrow<std::invalid_argument>([&] { with(matrix); }, {"matrix is singular"});
  matrix = orthographic(1);
  matrix.row(2).setZero();  // no side is the near one
  expectThrow<std::invalid_argument>([&] { with(matrix); }, {"matrix is singular"});
  matrix(1, 3) = std::numeric_limits<double>::quiet_NaN();
  expectThrow<std::invalid_argument>([&] { with(matrix); }, {"matrix", "nan", "row 1", "column 3"});
  expectThrow<std::invalid_argument>(
      [&] {
        project(surface, surface.vertexData(surface.positions()), at, orthographic(1), {1, 1},
                nullptr);
      },
      {"3 columns"});
}

TEST(Blend, WhatHasNoWeightStaysAsItIs) {
  const Colours below = Colours::Random(100, 4), above = Colours::Random(100, 4).cwiseAbs();
  for (const BlendMode mode : {BlendMode::mix, BlendMode::add, BlendMode::multiply}) {
    for (const bool premultiplied : {false, true}) {
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(100);
      EXPECT_TRUE(blendOver(below, above, none, mode, premultiplied) == below);
    }
  }
}

TEST(Blend, HalfOfRedOverBlueIsPurple) {
  Colours below(1, 4), above(1, 4), expected(1, 4);
  below << 0, 0, 1, 1;
  above << 1, 0, 0, 0.5f;
  expected << 0.25f, 0, 0.75f, 1;
  EXPECT_TRUE(blendOver(below, above, Eigen::VectorXd::Constant(1, 0.5)).isApprox(expected));
  below << 0, 0, 0.25f, 0.5f;  // straight: 0.5
  expected << 0.25f, 0, 0.1875f, 0.625f;
  EXPECT_TRUE(blendOver(below, above, Eigen::VectorXd::Constant(1, 0.5), BlendMode::mix, true)
                  .isApprox(expected));
}

TEST(Box, SidesSeeTheBoxFromOutside) {
  Random random(6);
  Eigen::Matrix4d to_box = Eigen::Matrix4d::Identity();
  to_box.topLeftCorner<3, 3>() = Eigen::Matrix3d::Random() + 2 * Eigen::Matrix3d::Identity();
  const LimitSurface surface = limitSurface(cube());
  const auto sides = boxSides(to_box);
  for (int side = 0; side < 6; ++side) {
    const Projector projector(sides[static_cast<std::size_t>(side)], surface);
    const Vector3 outward = (side % 2 == 0 ? 1 : -1) * Vector3::Unit(side / 2);
    const auto at = [&](const Vector3& in_box) {
      return projector.see(to_box.topLeftCorner<3, 3>().inverse() * in_box);
    };
    EXPECT_NEAR(at(outward).depth, -1, 1e-12);
    EXPECT_NEAR(at(-outward).depth, 1, 1e-12);
    EXPECT_LE((at(outward).st - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-12);
    const Vector3 up = side < 4 ? Vector3::UnitZ() : Vector3::UnitY();
    EXPECT_LE((at(outward + up).st - Eigen::Vector2d(0.5, 1)).norm(), 1e-12);
    EXPECT_LE((at(outward + up.cross(outward)).st - Eigen::Vector2d(1, 0.5)).norm(), 1e-12);
  }
}

TEST(Box, WeightsBlendBetweenSides) {
  Points normals(3, 3);
  normals << 2, 0, 0, -1, 1, 0, 0, 0.6, -0.8;
  const Eigen::Matrix4d same = Eigen::Matrix4d::Identity();
  BoxWeights expected(3, 6);
  expected << 1, 0, 0, 0, 0, 0, /**/ 0, 1, 0, 0, 0, 0, /**/ 0, 0, 0, 0, 0, 1;
  EXPECT_TRUE(boxWeights(normals, 0, same) == expected);
  // 0.6 / 0.8 is 0.25 above 0.5, 1 is 0.5 above it.
  expected << 1, 0, 0, 0, 0, 0, /**/ 0, 0.5, 0.5, 0, 0, 0, /**/ 0, 0, 1. / 3, 0, 0, 2. / 3;
  EXPECT_LE((boxWeights(normals, 0.5, same) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace
}  // namespace limitsurf::test
