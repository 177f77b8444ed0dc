// SPDX-License-Identifier: Apache-2.0
//
// Bounds of the normals of parts of patches, also of patches that are squeezed so that their
// tangents are nearly parallel, and what they say about feet of perpendiculars.
#include "limitsurf/search/normals/normal_polynomial.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/random.h"

namespace limitsurf::test {
namespace {

/// A patch that is squeezed along a random direction of its mean plane.
BezierPatch squeezedPatch(double squeeze, double bumps, Random& random) {
  const Eigen::AngleAxisd turn(random.uniform(0, 3), Vector3::UnitZ());
  const Eigen::Matrix3d map =
      Eigen::AngleAxisd(random.uniform(0, 3), random.vector(1).normalized()) *
      Vector3(1, squeeze, 1).asDiagonal() * turn;
  BezierPatch patch;
  patch.anchor.setZero();
  for (int i = 0; i < 16; ++i) {
    const Vector3 bump = random.vector(0.05);
    const Vector3 at = map * Vector3(i % 4 / 3. + bump[0], i / 4 / 3. + bump[1], bumps * bump[2]);
    patch.points[i] = {at[0], at[1], at[2], 0};
  }
  return patch;
}

ParameterRectangle rectangleIn(Random& random) {
  const double s_size = std::exp2(-random.below(12)), t_size = std::exp2(-random.below(12));
  return {s_size * random.below(static_cast<int>(1 / s_size)),
          t_size * random.below(static_cast<int>(1 / t_size)), s_size, t_size};
}

TEST(NormalPolynomial, ConesContainTheNormals) {
  Random random(1);
  int known = 0;
  for (int round = 0; round < 3000; ++round) {
    const double squeeze = std::pow(10., random.uniform(-6, 0));
    const BezierPatch patch = squeezedPatch(squeeze, random.below(2) * squeeze, random);
    const ParameterRectangle on = rectangleIn(random);
    const NormalPolynomial::Cone cone = NormalPolynomial(patch, 0).cone(on);
    known += std::isfinite(cone.tangent);
    for (int place = 0; place < 20; ++place) {
      BezierPatch::Values at;
      patch.evaluate<1>(on.s + on.s_size * random.uniform(), on.t + on.t_size * random.uniform(),
                        at);
      const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
      const Vector3 axis = cone.axis.head<3>();
      const double along = normal.dot(axis), rounding = 1e-15 * ds.norm() * dt.norm();
      EXPECT_LE((normal - along * axis).norm(), cone.tangent * (along + rounding) + rounding);
    }
  }
  EXPECT_GT(known, 2000);
}

/// Searching points on normals of a patch's part: it has a foot, and none of its neighbours' points
/// takes that away.
TEST(NormalPolynomial, FeetAreNotDenied) {
  Random random(2);
  int denied = 0;
  for (int round = 0; round < 6000; ++round) {
    const double squeeze = std::pow(10., random.uniform(-6, 0));
    const BezierPatch patch = squeezedPatch(squeeze, random.below(2) * squeeze, random);
    const ParameterRectangle on = rectangleIn(random);
    const auto part = [&](const ParameterRectangle& of, const Vector3& from) {
      std::array<BezierPatch::Point, 16> points;
      std::copy(patch.points, patch.points + 16, points.begin());
      for (int i = 0; i < 4; ++i) bezier::cut(&points[4 * i], 1, of.s, of.s + of.s_size);
      for (int i = 0; i < 4; ++i) bezier::cut(&points[i], 4, of.t, of.t + of.t_size);
      for (BezierPatch::Point& point : points)
        point -= BezierPatch::Point(from[0], from[1], from[2], 0);
      return points;
    };
    BezierPatch::Values at;
    patch.evaluate<1>(on.s + on.s_size * random.uniform(), on.t + on.t_size * random.uniform(), at);
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt).normalized();
    const Vector3 from = Vector3(at.value.head<3>()) + random.below(2) * random.uniform() * normal;
    const NormalPolynomial normals(patch, 0);
    EXPECT_FALSE(normals.hasNoFoot(on, part(on, from).data(), 1e-14)) << squeeze;
    // Parts of the patch elsewhere are left out, unless the patch bends too much.
    const ParameterRectangle other = rectangleIn(random);
    denied += normals.hasNoFoot(other, part(other, from).data(), 1e-14);
  }
  EXPECT_GT(denied, 3000);
}

/// A narrow strip of a cylinder over a parabola, whose parameters both lead along it. Its normals
/// lean far along it, and across by a part of its width.
BezierPatch narrowPatch(double width, double bend, Random& random) {
  const Eigen::Matrix3d turn(
      Eigen::AngleAxisd(random.uniform(0, 3), random.vector(1).normalized()));
  const double shear = random.uniform(-1, 1);
  constexpr double kSquare[4] = {0, 0, 1. / 3, 1};  // the Bezier points of t^2
  BezierPatch patch;
  patch.anchor.setZero();
  for (int i = 0; i < 16; ++i) {
    const double s = i % 4 / 3., t = i / 4 / 3.;
    const double height = kSquare[i % 4] + 2 * shear * s * t + shear * shear * kSquare[i / 4];
    const Vector3 at = turn * Vector3(s + shear * t, width * (t + 0.1 * random.uniform()),
                                      bend * height + 0.1 * width * width * random.uniform());
    patch.points[i] = {at[0], at[1], at[2], 0};
  }
  return patch;
}

TEST(NormalPolynomial, NarrowPatchesBesideAPointHaveNoFoot) {
  Random random(3);
  int beside = 0, all = 0;
  for (int round = 0; round < 4000; ++round) {
    const double width = std::pow(10., random.uniform(-6, -1));
    const BezierPatch patch = narrowPatch(width, random.uniform(-0.3, 0.3), random);
    BezierPatch::Values at;
    patch.evaluate<1>(random.uniform(), random.uniform(), at);
    const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt).normalized();
    const NormalPolynomial normals(patch, 0);
    const auto isBeside = [&](const Vector3& from) {
      std::array<BezierPatch::Point, 16> points;
      for (int i = 0; i < 16; ++i) {
        points[i] = patch.points[i] - BezierPatch::Point(from[0], from[1], from[2], 0);
      }
      return normals.hasNoFoot({0, 0, 1, 1}, points.data(), 1e-14);
    };
    // A point with a foot, near the patch or as far as it is long.
    const double height = std::pow(10., random.uniform(-5, 0)) * (random.below(2) ? 1 : -1);
    const Vector3 from = Vector3(at.value.head<3>()) + height * normal;
    ASSERT_FALSE(isBeside(from)) << width << " " << height;
    // The same point, moved across by some widths: the normals lean by about a width.
    const Vector3 across = normal.cross(ds).normalized();
    beside += isBeside(from + (3 + std::abs(height)) * width * across);
    ++all;
  }
  EXPECT_GT(beside, 9 * all / 10);
}

}  // namespace
}  // namespace limitsurf::test
