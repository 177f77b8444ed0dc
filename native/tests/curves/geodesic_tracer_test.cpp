// SPDX-License-Identifier: Apache-2.0
//
// Geodesics on surfaces where they are known: planes, cylinders over splines, planes of symmetry.
#include "limitsurf/curves/geodesic_tracer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

Vector3 positionAt(const LimitSurface& surface, const Location& at) {
  return surface.evaluate(std::vector<Location>{at}).position.row(0);
}

TEST(GeodesicTracer, IsStraightInAPlane) {
  // Inner vertices are moved within the plane: faces are not parallelograms.
  Cage cage = perturbed(fullGrid(10, 10), 0.2, 3);
  cage.positions.col(2).setZero();
  const LimitSurface surface = limitSurface(cage);
  const GeodesicTracer tracer(surface);
  const std::vector<double> lengths = {0.1, 1, 2.5, 4};
  for (int i = 0; i < 200; ++i) {
    const Location from = {10 * (4 + i % 2) + 4, 0.005 * i, 0.37};
    const Vector3 direction(std::cos(0.1 * i), std::sin(0.1 * i), 0);
    const GeodesicTracer::Path path = tracer.trace(from, direction, lengths);
    ASSERT_EQ(path.stops.size(), lengths.size());
    for (std::size_t k = 0; k < lengths.size(); ++k) {
      const Vector3 truth = positionAt(surface, from) + lengths[k] * direction;
      EXPECT_LT((path.stops[k].position - truth).norm(), kGeodesicError * lengths[k]);
      EXPECT_LT((positionAt(surface, path.stops[k].at) - path.stops[k].position).norm(), 1e-8);
    }
  }
}

/// A tube whose cross-section is the closed cubic B-spline of irregular points; its axis is z.
Cage tube(int around, int rows) {
  Cage cage;
  cage.positions.resize(around * (rows + 1), 3);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i < around; ++i) {
      const double angle = 6.283185307179586 * i / around, radius = 1 + 0.3 * (i % 3);
      cage.positions.row(around * j + i) << radius * std::cos(angle), radius * std::sin(angle),
          0.5 * j;
      if (j < rows) {
        const int next = (i + 1) % around;
        cage.faces.push_back(
            {around * j + i, around * j + next, around * (j + 1) + next, around * (j + 1) + i});
      }
    }
  }
  return cage;
}

/// The arc length of the cross-section from spline parameter 0 to x, by a fine rule of Simpson.
double sectionLength(const Cage& cage, int around, double x) {
  const auto speed = [&](double at) {
    const int i = static_cast<int>(std::floor(at));
    const double t = at - i;
    const double w[4] = {-(1 - t) * (1 - t) / 2, (3 * t * t - 4 * t) / 2,
                         (-3 * t * t + 2 * t + 1) / 2, t * t / 2};
    Vector3 sum = Vector3::Zero();
    for (int k = 0; k < 4; ++k) {
      sum += w[k] * cage.positions.row(((i + k - 1) % around + around) % around).transpose();
    }
    sum[2] = 0;
    return sum.norm();
  };
  double sum = 0;
  for (int i = 0; i < std::ceil(x); ++i) {
    const double end = std::min(x, i + 1.), h = (end - i) / 200;
    for (int k = 0; k < 200; ++k) {
      const double a = i + h * k;
      const double b = k == 199 ? end - 1e-15 : a + h;
      sum += (b - a) / 6 * (speed(a) + 4 * speed((a + b) / 2) + speed(b));
    }
  }
  return sum;
}

TEST(GeodesicTracer, IsAHelixOnACylinder) {
  const int around = 9, rows = 40;
  const Cage cage = tube(around, rows);
  const LimitSurface surface = limitSurface(cage);
  const GeodesicTracer tracer(surface);
  for (const double slope : {0., 0.2, 0.7}) {
    // From spline parameter 0, to the right: face i of a row spans the parameters i to i + 1.
    const int row = 12;
    const Location from = {around * row, 0, 0.3};
    const Evaluation start =
        surface.evaluate(std::vector<Location>{from}, Derivatives::first, true);
    const Vector3 sideways = Vector3(start.du.row(0)).normalized();
    const Vector3 direction = std::cos(slope) * sideways + std::sin(slope) * Vector3::UnitZ();
    const double length = 9;
    const GeodesicTracer::Path path = tracer.trace(from, direction, {length});
    ASSERT_EQ(path.stops.size(), 1u);
    const GeodesicTracer::Stop& stop = path.stops[0];
    EXPECT_NEAR(stop.position[2], start.position(0, 2) + length * std::sin(slope),
                kGeodesicError * length);
    // Once around, and on.
    const double whole = sectionLength(cage, around, around);
    const double parameter = stop.at.face % around + stop.at.u;
    const double turns = std::floor(length * std::cos(slope) / whole);
    EXPECT_NEAR(turns * whole + sectionLength(cage, around, parameter), length * std::cos(slope),
                kGeodesicError * length);
  }
}

TEST(GeodesicTracer, GoesTheSameWayBack) {
  Random random(5);
  for (const Cage& cage : {cube(), perturbed(torus(8, 6), 0.1, 2), mixture(3), ngon(5, 2)}) {
    const LimitSurface surface = limitSurface(cage);
    const GeodesicTracer tracer(surface);
    for (int i = 0; i < 100; ++i) {
      const Location from = {i % surface.faceCount(), random.uniform(0.05, 0.95),
                             random.uniform(0.05, 0.95)};
      const Evaluation here = surface.evaluate(std::vector<Location>{from}, Derivatives::first);
      const Vector3 direction =
          random.uniform(-1, 1) * Vector3(here.du.row(0)) + Vector3(here.dv.row(0));
      const double length = 0.6 * diagonal(cage.positions);
      const GeodesicTracer::Path there = tracer.trace(from, direction, {length});
      if (there.stops.empty()) {
        EXPECT_LT(there.length, length);
        continue;
      }
      const GeodesicTracer::Path back =
          tracer.trace(there.stops[0].at, -there.stops[0].direction, {length});
      ASSERT_EQ(back.stops.size(), 1u);
      EXPECT_LT((back.stops[0].position - Vector3(here.position.row(0))).norm(), 2e-3 * length);
    }
  }
}

TEST(GeodesicTracer, PassesAnExtraordinaryVertexStraightOn) {
  // The plane through opposite edges of a cube is one of symmetry, and runs through vertices.
  const LimitSurface surface = limitSurface(cube());
  const GeodesicTracer tracer(surface);
  const Location middle = {0, 0.5, 0.5};
  const Vector3 from = positionAt(surface, middle);
  const Vector3 corner = positionAt(surface, {0, 1, 1});
  const Vector3 normal =
      surface.evaluate(std::vector<Location>{middle}, Derivatives::first, true).normal.row(0);
  const Vector3 plane = normal.cross(corner - from).normalized();
  const std::vector<double> lengths = {0.3, 0.6, 0.9, 1.2};
  const GeodesicTracer::Path path = tracer.trace(middle, corner - from, lengths);
  ASSERT_EQ(path.stops.size(), lengths.size());
  bool is_beyond = false;
  for (const GeodesicTracer::Stop& stop : path.stops) {
    EXPECT_LT(std::abs((stop.position - from).dot(plane)), 1e-3);
    is_beyond |= stop.at.face != 0;
  }
  EXPECT_TRUE(is_beyond);
}

TEST(GeodesicTracer, KeepsItsAngleAcrossASharpEdge) {
  // Two half planes at a right angle unfold to one plane.
  Cage cage = fullGrid(8, 8);
  for (int v = 0; v < cage.vertexCount(); ++v) {
    const double x = cage.positions(v, 0);
    cage.positions(v, 0) = std::min(x, 4.);
    cage.positions(v, 2) = std::max(x - 4, 0.);
  }
  for (int j = 0; j < 8; ++j) {
    sharpenEdge(cage, 9 * j + 4, 9 * (j + 1) + 4, 10);
  }
  const LimitSurface surface = limitSurface(cage);
  const GeodesicTracer tracer(surface);
  const Vector3 direction = Vector3(1, 0.4, 0).normalized();
  const GeodesicTracer::Path path = tracer.trace({8 * 3 + 2, 0.5, 0.5}, direction, {3});
  ASSERT_EQ(path.stops.size(), 1u);
  const double x = 2.5 + 3 * direction[0], y = 3.5 + 3 * direction[1];
  EXPECT_LT((path.stops[0].position - Vector3(4, y, x - 4)).norm(), 3 * kGeodesicError);
}

TEST(GeodesicTracer, EndsAtTheBoundaryAndAtTargets) {
  const LimitSurface surface = limitSurface(fullGrid(6, 6));
  const GeodesicTracer tracer(surface);
  const Location from = {14, 0.5, 0.5};
  const GeodesicTracer::Path path = tracer.trace(from, Vector3::UnitX(), {1, 100});
  EXPECT_EQ(path.stops.size(), 1u);
  EXPECT_FALSE(path.hit);
  EXPECT_NEAR(path.length, 3.5, 1e-6);
  const std::vector<bool> targets = tracer.targets({{2 * 7 + 4, 3 * 7 + 4}});
  const GeodesicTracer::Path stopped = tracer.trace(from, Vector3::UnitX(), {100}, &targets);
  EXPECT_TRUE(stopped.hit);
  EXPECT_NEAR(stopped.length, 1.5, 1e-6);
}

}  // namespace
}  // namespace limitsurf::test
