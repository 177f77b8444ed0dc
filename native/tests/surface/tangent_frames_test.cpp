// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/tangent_frames.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "limitsurf/surface/map_derivatives.h"
#include "limitsurf/uv/map_distortion.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/truth/decompositions.h"
#include "support/truth/deep_subdivision.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// A map without folds that is no projection of the positions. It is vertex data, so that
/// subdivision gives its true values as well.
Cage mapOf(const Cage& cage, std::uint64_t seed, bool mirrored) {
  Cage map = perturbed(cage, 0.05, seed);
  Points at = map.positions;
  map.positions.col(0) = 0.3 * at.col(0) + 0.2 * at.col(1) + 0.1 * at.col(2);
  map.positions.col(1) = 0.5 * at.col(1) - 0.1 * at.col(0) + 0.1 * at.col(2);
  if (mirrored) {
    map.positions.col(0) *= -1;
  }
  map.positions.col(2).setZero();
  return map;
}

SurfaceData mapOn(const LimitSurface& surface, const Cage& map) {
  return surface.vertexData(map.positions.leftCols<2>());
}

double largest(const Truth& t) { return std::max(t[kDu].norm(), t[kDv].norm()); }

/// The direction of dP/dU from the witness's derivatives, of any length, with the map's Jacobian.
struct Expected {
  Vector3 along;
  double jacobian;
  double size;  ///< the sizes of the products whose difference it is, at least those on the face
};

Expected expected(DeepSubdivision& surface, DeepSubdivision& map, const Location& at) {
  const Truth p = surface.evaluate(at), m = map.evaluate(at);
  const Location middle{at.face, 0.5, 0.5};
  const double jacobian = m[kDu].x() * m[kDv].y() - m[kDv].x() * m[kDu].y();
  return {(jacobian < 0 ? -1 : 1) * (p[kDu] * m[kDv].y() - p[kDv] * m[kDu].y()), jacobian,
          std::max(largest(p), largest(surface.evaluate(middle))) *
              std::max(largest(m), largest(map.evaluate(middle)))};
}

void compare(const std::string& name, const Cage& cage, bool mirrored, double& worst) {
  const LimitSurface surface = limitSurface(cage);
  const Cage map_cage = mapOf(cage, 5, mirrored);
  const SurfaceData map = mapOn(surface, map_cage);
  DeepSubdivision deep(cage), deep_map(map_cage);
  Random random(4);
  std::vector<Location> at;
  for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
    at += anywhere(face, 2, random);
    at += shells(face, 0, {3 + face % 10});
  }
  const auto frames = tangentFrames(surface, map, at);
  const MapDistortion distortion = mapDistortion(surface, map, at);
  int compared = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::string where = name + ", " + describe(at[i]);
    const Matrix3 frame = Eigen::Map<const Matrix3>(frames.row(row).data());
    EXPECT_LE((frame.transpose() * frame - Matrix3::Identity()).cwiseAbs().maxCoeff(), 1e-14)
        << where;
    const Expected e = expected(deep, deep_map, at[i]);
    const Truth p = deep.evaluate(at[i]), m = deep_map.evaluate(at[i]);
    const Vector3 normal = p[kNormal];
    if (!normal.allFinite() || std::abs(e.jacobian) < 1e-3 * m[kDu].norm() * m[kDv].norm()) {
      continue;
    }
    ++compared;
    const Vector3 tangent = (e.along - e.along.dot(normal) * normal).normalized();
    const double condition = e.size / e.along.norm();
    const double error = frame.col(0).cross(tangent).norm() / condition;
    worst = std::max(worst, error);
    EXPECT_LE(error, kTangentError) << where;
    EXPECT_GT(frame.col(0).dot(tangent), 0) << where;
    EXPECT_LE((frame.col(2) - normal).norm(), kNormalError) << where;
    EXPECT_EQ(frame.determinant() < 0, e.jacobian < 0) << where;

    Eigen::Matrix<double, 3, 2> position;
    position << p[kDu], p[kDv];
    Eigen::Matrix2d map_matrix;
    map_matrix << m[kDu].head<2>(), m[kDv].head<2>();
    const Eigen::Matrix<double, 3, 2> stretch = position * map_matrix.inverse();
    const Eigen::Vector2d values = singularValues(stretch);
    const double scale = std::pow(largest(deep_map.evaluate({at[i].face, 0.5, 0.5})), 2);
    const double bound =
        kDistortionError *
        std::max(1.0, std::max(scale, std::pow(largest(m), 2)) / std::abs(e.jacobian)) *
        std::max(1.0, largest(deep.evaluate({at[i].face, 0.5, 0.5})) / largest(p));
    EXPECT_NEAR(distortion.stretch_high(row) / values(0), 1, bound) << where;
    EXPECT_NEAR(distortion.stretch_low(row) / values(1), 1, bound * values(0) / values(1)) << where;
    EXPECT_NEAR(distortion.area(row) / (values(0) * values(1)), 1, bound * values(0) / values(1))
        << where;
  }
  EXPECT_GT(compared, static_cast<int>(at.size()) / 2) << name;
}

TEST(TangentFrames, AreThoseOfTheDerivatives) {
  double worst = 0;
  for (const bool mirrored : {false, true}) {
    compare("cross", cross(), mirrored, worst);
    compare("torus", torus(9, 6), mirrored, worst);
    compare("mixture", mixture(2), mirrored, worst);
  }
  for (const int faces : {3, 5, 8}) {
    compare("closed fan", fan(faces, true, 3), false, worst);
    compare("open fan", fan(faces, false, 4), true, worst);
  }
  std::printf("  worst relative to the bound's condition: %.1e\n", worst);
}

TEST(TangentFrames, AtIrregularVerticesAreThoseOfTheirNeighbourhood) {
  const Cage cage = fan(5, true, 7), map_cage = mapOf(cage, 5, true);
  const LimitSurface surface = limitSurface(cage);
  const SurfaceData map = mapOn(surface, map_cage);
  const double h = std::ldexp(1.0, -30);
  const auto exact = tangentFrames(surface, map, std::vector<Location>{{0, 0, 0}});
  const auto near = tangentFrames(surface, map, std::vector<Location>{{0, h, h}});
  EXPECT_LE((exact - near).cwiseAbs().maxCoeff(), 1e-3);
  const MapDistortion at_it = mapDistortion(surface, map, std::vector<Location>{{0, 0, 0}});
  const MapDistortion beside = mapDistortion(surface, map, std::vector<Location>{{0, h, h}});
  EXPECT_NEAR(at_it.area(0) / beside.area(0), 1, 1e-3);
}

TEST(TangentFrames, OfSingularMapsAreTheSurfacesOwn) {
  const Cage cage = perturbed(grid(3, 3), 0.1, 1);
  const LimitSurface surface = limitSurface(cage);
  Cage line = mapOf(cage, 5, false);
  line.positions.col(1) = line.positions.col(0);
  const std::vector<Location> at = {{0, 0.25, 0.5}, {4, 0, 0}, {8, 1, 1}};
  for (const SurfaceData& map :
       {mapOn(surface, line), surface.vertexData(DataRows::Zero(cage.vertexCount(), 2))}) {
    EXPECT_EQ(tangentFrames(surface, map, at), surface.frames(at));
    const MapDistortion d = mapDistortion(surface, map, at);
    EXPECT_FALSE(d.area.hasNaN());
    EXPECT_FALSE(d.area.allFinite());
    EXPECT_FALSE(d.stretch_high.allFinite());
  }
}

TEST(TangentFrames, OfAPlaneAreItsAxes) {
  const Cage cage = grid(3, 2);
  const LimitSurface surface = limitSurface(cage);
  DataRows values = cage.positions.leftCols<2>();
  values.col(0) *= -0.25;
  values.col(1) *= 0.5;
  const SurfaceData map = surface.vertexData(values);
  const std::vector<Location> at = {{0, 0.25, 0.5}, {2, 0.7, 0.2}};
  Eigen::Matrix<double, 1, 9> expected;
  expected << -1, 0, 0, 0, 1, 0, 0, 0, 1;
  const auto frames = tangentFrames(surface, map, at);
  const MapDistortion d = mapDistortion(surface, map, at);
  for (Eigen::Index row = 0; row < 2; ++row) {
    EXPECT_LE((frames.row(row) - expected).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_NEAR(d.area(row), 8, 1e-12);
    EXPECT_NEAR(d.stretch_high(row), 4, 1e-12);
    EXPECT_NEAR(d.stretch_low(row), 2, 1e-12);
  }
}

TEST(TangentFrames, AreTheSameOnAnyNumberOfThreads) {
  const Cage cage = mixture(3);
  const LimitSurface surface = limitSurface(cage);
  const SurfaceData map = mapOn(surface, mapOf(cage, 5, false));
  Random random(1);
  const std::vector<Location> at = everywhere(cage, {4}, 40, random);
  EXPECT_EQ(tangentFrames(surface, map, at, 1), tangentFrames(surface, map, at, 2));
}

TEST(TangentFrames, RefuseOtherMaps) {
  const LimitSurface surface = limitSurface(cube()), other = limitSurface(cross());
  const std::vector<Location> at = {{0, 0.5, 0.5}};
  EXPECT_THROW(tangentFrames(surface, surface.vertexData(cube().positions), at),
               std::invalid_argument);
  EXPECT_THROW(tangentFrames(surface, mapOn(other, cross()), at), std::invalid_argument);
  EXPECT_THROW(mapDistortion(surface, mapOn(other, cross()), at), std::invalid_argument);
}

}  // namespace
}  // namespace limitsurf::test
