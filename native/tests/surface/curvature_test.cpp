// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/corner_points.h"
#include "support/truth/decompositions.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// Gaussian and mean curvature by the textbook formulas.
struct Expected {
  double gaussian, mean;
};

Expected fromDerivatives(const Truth& t) {
  const double E = t[kDu].dot(t[kDu]), F = t[kDu].dot(t[kDv]), G = t[kDv].dot(t[kDv]);
  const double L = t[kDuu].dot(t[kNormal]), M = t[kDuv].dot(t[kNormal]),
               N = t[kDvv].dot(t[kNormal]);
  const double area = E * G - F * F;
  return {(L * N - M * M) / area, (E * N - 2 * F * M + G * L) / (2 * area)};
}

bool sound(const Truth& t) { return t[kDu].normalized().cross(t[kDv].normalized()).norm() > 0.05; }

void compare(const std::string& name, const Cage& cage, double& worst) {
  const LimitSurface surface = limitSurface(cage);
  DeepSubdivision deep(cage);
  Random random(4);
  std::vector<Location> at;
  for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
    at += anywhere(face, 4, random);
    at += shells(face, 0, {3, 8, 20, 40});
  }
  const Curvature curvature = surface.curvature(at);
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const Truth truth = deep.evaluate(at[i]);
    if (!sound(truth)) continue;
    const std::string where = name + ", " + describe(at[i]);
    const Expected expected = fromDerivatives(truth);
    const double k1 = curvature.k1[i], k2 = curvature.k2[i];
    // The size of curvatures here: what they would be if all second derivatives were normal.
    const double size = (truth[kDuu].norm() + truth[kDuv].norm() + truth[kDvv].norm()) /
                        std::min(truth[kDu].squaredNorm(), truth[kDv].squaredNorm());
    const double mean_error = std::abs(curvature.mean[i] - expected.mean) / size;
    const double gaussian_error = std::abs(curvature.gaussian[i] - expected.gaussian) / size / size;
    worst = std::max({worst, mean_error, gaussian_error});
    EXPECT_LE(mean_error, 1e-8) << where;
    EXPECT_LE(gaussian_error, 1e-8) << where;
    EXPECT_GE(k1, k2) << where;
    EXPECT_NEAR(k1 + k2, 2 * curvature.mean[i], 1e-12 * size) << where;
    EXPECT_NEAR(k1 * k2, curvature.gaussian[i], 1e-12 * size * size) << where;

    const Vector3 d1 = curvature.direction1.row(i), d2 = curvature.direction2.row(i);
    EXPECT_NEAR(d1.norm(), 1, 1e-12) << where;
    EXPECT_NEAR(d2.norm(), 1, 1e-12) << where;
    EXPECT_NEAR(d1.dot(d2), 0, 1e-10) << where;
    EXPECT_NEAR(d1.dot(truth[kNormal]), 0, 1e-10) << where;
    EXPECT_NEAR(d2.dot(truth[kNormal]), 0, 1e-10) << where;
    // The curvature of the normal section in direction1 is k1.
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << truth[kDu], truth[kDv];
    const Eigen::Vector2d uv =
        (tangents.transpose() * tangents).inverse() * (tangents.transpose() * d1);
    const Vector3 bend =
        uv[0] * uv[0] * truth[kDuu] + 2 * uv[0] * uv[1] * truth[kDuv] + uv[1] * uv[1] * truth[kDvv];
    EXPECT_NEAR(bend.dot(truth[kNormal]), k1, 1e-7 * size) << where;
  }
}

TEST(Curvature, IsThatOfTheDerivatives) {
  double worst = 0;
  compare("cross", cross(), worst);
  compare("torus", torus(9, 6), worst);
  for (int faces : {3, 5, 6, 8}) {
    compare("closed fan", fan(faces, true, faces), worst);
    compare("open fan", fan(faces, false, faces), worst);
  }
  compare("mixture", mixture(2), worst);
  std::printf("  worst relative to the second derivatives: %.1e\n", worst);
}

TEST(Curvature, IsNegativeWhereASphereIsSeenFromOutside) {
  const LimitSurface surface = limitSurface(cube());
  const std::vector<Location> at = {{0, 0.5, 0.5}, {1, 0.4, 0.6}, {5, 0.25, 0.75}};
  const Curvature curvature = surface.curvature(at);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(curvature.k1[i], 0);
    EXPECT_LT(curvature.mean[i], 0);
    EXPECT_GT(curvature.gaussian[i], 0);
  }
}

TEST(Curvature, VanishesOnAPlane) {
  const LimitSurface surface = limitSurface(grid(4, 4));
  const std::vector<Location> at = {{0, 0.3, 0.3}, {5, 0, 0.5}, {10, 1, 1}};
  const Curvature curvature = surface.curvature(at);
  EXPECT_LE(curvature.k1.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LE(curvature.k2.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LE((curvature.direction1.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
}

TEST(Curvature, IsMissingAtIrregularVerticesAlone) {
  for (const Cage& cage : {perturbed(cube(), 0.2, 1), perturbed(grid(3, 3), 0.2, 2), mixture(1)}) {
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    std::vector<Location> at;
    for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
      for (int corner = 0; corner < 4; ++corner) at.push_back(cornerLocation(face, corner));
    }
    const Curvature curvature = surface.curvature(at);
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      const bool regular = corners.at(at[i])->regular();
      for (const Eigen::VectorXd* values :
           {&curvature.gaussian, &curvature.mean, &curvature.k1, &curvature.k2}) {
        EXPECT_EQ(std::isnan((*values)[i]), !regular) << describe(at[i]);
      }
      EXPECT_EQ(curvature.irregular[i], !regular) << describe(at[i]);
    }
  }
}

/// The mean that LimitSurface::curvature() promises around the vertex (0, 0) of the faces 0, 4, 8,
/// ... of a fan, from subdivision, and the size of the averaged curvatures.
Eigen::Matrix3d meanAround(const Cage& cage, const Vector3& vertex_normal, double radius,
                           double& size) {
  DeepSubdivision deep(cage);
  std::vector<std::pair<double, Truth>> places;
  Vector3 normal = Vector3::Zero();
  for (int face = 0; face < static_cast<int>(cage.faces.size()); face += 4) {
    for (const auto& [u, v] : {std::pair{1., 0.25}, {1., 0.75}, {0.75, 1.}, {0.25, 1.}}) {
      const Truth truth = deep.evaluate({face, radius * u, radius * v});
      const double area = truth[kDu].cross(truth[kDv]).norm();
      places.push_back({area, truth});
      normal += area * truth[kNormal];
    }
  }
  normal = vertex_normal.hasNaN() ? normal.normalized() : vertex_normal;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double total = 0;
  size = 0;
  for (const auto& [area, truth] : places) {
    // The shape operator in space: second fundamental form, raised on both sides by the tangents'
    // dual vectors.
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << truth[kDu], truth[kDv];
    const Eigen::Matrix<double, 3, 2> dual = tangents * (tangents.transpose() * tangents).inverse();
    Eigen::Matrix2d second;
    second << truth[kDuu].dot(truth[kNormal]), truth[kDuv].dot(truth[kNormal]),
        truth[kDuv].dot(truth[kNormal]), truth[kDvv].dot(truth[kNormal]);
    const Eigen::Matrix3d turn = rotationBetween(truth[kNormal], normal);
    const Eigen::Matrix<double, 3, 2> turned = turn * dual;
    sum += area * turned * second * turned.transpose();
    total += area;
    size = std::max(size, (truth[kDuu].norm() + truth[kDuv].norm() + truth[kDvv].norm()) /
                              std::min(truth[kDu].squaredNorm(), truth[kDv].squaredNorm()));
  }
  return sum / total;
}

TEST(Curvature, AveragesAroundIrregularVerticesAreThoseOfSubdivision) {
  NamedCages cages;
  for (int faces : {3, 5, 6, 11}) cages.push_back({"closed", fan(faces, true, faces)});
  for (int faces : {1, 3, 4, 7}) cages.push_back({"open", fan(faces, false, faces)});
  cages.push_back({"dart", fan(5, true, 4)});
  sharpenEdge(cages.back().second, 0, 1, 10);
  cages.push_back({"cone", fan(5, true, 5)});
  sharpenVertex(cages.back().second, 0, 10);
  cages.push_back({"pinned", fan(3, false, 6)});
  sharpenVertex(cages.back().second, 0, 10);
  cages.push_back({"semi-sharp", fan(5, true, 7)});
  sharpenVertex(cages.back().second, 0, 1.5);
  cages.push_back({"several", perturbed(fan(5, true, 8), 0.1, 1)});
  sharpenEdge(cages.back().second, 0, 1, 2);
  double worst = 0;
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = {{0, 0, 0}};
    const Vector3 normal = surface.evaluate(at, Derivatives::first, true).normal.row(0);
    for (const double radius : {0.5, 1. / 8, kCurvatureRadius, 0x1p-12}) {
      const std::string where =
          name + " " + std::to_string(cage.faces.size() / 4) + ", radius " + std::to_string(radius);
      double size = 0;
      const Eigen::Matrix3d expected = meanAround(cage, normal, radius, size);
      const Curvature got = surface.curvature(at, IrregularRule::average, radius);
      ASSERT_TRUE(got.irregular[0]) << where;
      const Vector3 d1 = got.direction1.row(0), d2 = got.direction2.row(0);
      const Eigen::Matrix3d tensor =
          got.k1[0] * d1 * d1.transpose() + got.k2[0] * d2 * d2.transpose();
      const double error = (tensor - expected).norm() / size;
      worst = std::max(worst, error);
      EXPECT_LE(error, kAverageCurvatureError) << where;
    }
  }
  std::printf("  worst relative to the second derivatives: %.1e\n", worst);
}

TEST(Curvature, OverflowsOnlyWhereItIsThatLarge) {
  // Curvature grows by a factor of 2.26 with each level around three faces, and by 1.4 and less
  // around five and more, while second derivatives leave the range of doubles.
  for (int faces : {3, 5, 6, 9}) {
    const LimitSurface surface = limitSurface(fan(faces, true, faces));
    for (double t : {1e-100, 1e-200, 0x1p-1000, 0x1p-1074}) {
      if (faces == 3 && t < 1e-200) continue;
      const std::vector<Location> at = {{0, t, t}};
      const Curvature curvature = surface.curvature(at);
      EXPECT_TRUE(std::isfinite(curvature.mean[0])) << faces << " faces, " << t;
      EXPECT_TRUE(std::isfinite(curvature.k1[0])) << faces << " faces, " << t;
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
