// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/throws.h"
#include "support/truth/corner_points.h"
#include "support/truth/decompositions.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// The larger of |k1| and |k2|.
double sizeOf(const TrueCurvature& k) { return std::max(std::abs(k.k1), std::abs(k.k2)); }

/// Compares with subdivision, relative to the larger principal curvature. Returns the largest error
/// of k1 and k2.
double compare(const std::string& name, const Cage& cage, const std::vector<Location>& at) {
  const LimitSurface surface = limitSurface(cage);
  DeepSubdivision deep(cage);
  const Curvature curvature = surface.curvature(at);
  double worst = 0;
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const std::string where = name + ", " + describe(at[i]);
    const TrueCurvature truth = deep.curvature(at[i]);
    const double size = sizeOf(truth);
    const double k1 = curvature.k1[i], k2 = curvature.k2[i];
    worst = std::max({worst, std::abs(k1 - truth.k1) / size, std::abs(k2 - truth.k2) / size});
    EXPECT_NEAR(k1, truth.k1, kCurvatureError * size) << where;
    EXPECT_NEAR(k2, truth.k2, kCurvatureError * size) << where;
    EXPECT_NEAR(curvature.mean[i], truth.mean, kCurvatureError * size) << where;
    EXPECT_NEAR(curvature.gaussian[i], truth.gaussian, 3 * kCurvatureError * size * size) << where;
    EXPECT_GE(k1, k2) << where;

    const Vector3 d1 = curvature.direction1.row(i), d2 = curvature.direction2.row(i);
    const Vector3 normal = deep.evaluate(at[i])[kNormal];
    EXPECT_NEAR(d1.norm(), 1, 1e-12) << where;
    EXPECT_NEAR(d2.norm(), 1, 1e-12) << where;
    EXPECT_LE((d1.cross(d2) - normal).norm(), kNormalError) << where;
    // The direction is the less determined the less k1 and k2 differ.
    const double turned = std::min((d1 - truth.direction1).norm(), (d1 + truth.direction1).norm());
    EXPECT_LE(turned * (truth.k1 - truth.k2), 2 * kCurvatureError * size) << where;
  }
  return worst;
}

double compareEverywhere(const std::string& name, const Cage& cage) {
  Random random(4);
  std::vector<Location> at;
  for (int face = 0; face < static_cast<int>(ptexFaces(cage).size()); ++face) {
    at += anywhere(face, 4, random);
    at += shells(face, 0, {3, 8, 20, 40});
  }
  return compare(name, cage, at);
}

TEST(Curvature, IsWrittenIntoMemoryOfTheCaller) {
  const LimitSurface surface = limitSurface(cube());
  const std::vector<Location> at{{0, 0.3, 0.2}, {1, 0, 0}, {4, 0x1p-20, 0x1p-22}, {5, 0.5, 1}};
  const Curvature expected = surface.curvature(at, IrregularRule::average);
  const std::size_t count = at.size();
  std::vector<double> numbers(10 * count);
  double* next = numbers.data();
  const auto rows = [&](std::size_t width) {
    const CurvatureArrays::Rows result{next, count};
    next += width * count;
    return result;
  };
  std::array<bool, 4> irregular{};
  CurvatureArrays arrays{
      rows(1), rows(1), rows(1), rows(1), rows(3), rows(3), {irregular.data(), count}};
  surface.curvature(at, arrays, IrregularRule::average);
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_EQ(arrays.gaussian.numbers[i], expected.gaussian[row]);
    EXPECT_EQ(arrays.mean.numbers[i], expected.mean[row]);
    EXPECT_EQ(arrays.k1.numbers[i], expected.k1[row]);
    EXPECT_EQ(arrays.k2.numbers[i], expected.k2[row]);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      EXPECT_EQ(arrays.direction1.numbers[3 * i + c], expected.direction1(row, column));
      EXPECT_EQ(arrays.direction2.numbers[3 * i + c], expected.direction2(row, column));
    }
    EXPECT_EQ(irregular[i], i == 1);
  }
  arrays.k2.count = 3;
  expectThrow<std::invalid_argument>([&] { surface.curvature(at, arrays); }, {"k2", "3", "4"});
}

TEST(Curvature, IsThatOfSubdivision) {
  double worst = 0;
  for (const auto& [name, cage] : NamedCages{{"cross", perturbed(cross(), 0.1, 2)},
                                             {"torus", torus(9, 6)},
                                             {"mixture", perturbed(mixture(2), 0.1, 1)}}) {
    worst = std::max(worst, compareEverywhere(name, cage));
  }
  std::printf("  worst relative to the larger principal curvature: %.1e\n", worst);
}

/// Rings of all kinds with these numbers of faces.
void compareRings(const std::vector<int>& numbers) {
  double worst = 0;
  for (const int faces : numbers) {
    NamedCages cages = {{"open", fan(faces, false, faces)}, {"pinned", fan(faces, false, 6)}};
    sharpenVertex(cages[1].second, 0, 10);
    if (faces > 2) {
      cages.push_back({"closed", fan(faces, true, faces)});
      cages.push_back({"dart", fan(faces, true, 4)});
      sharpenEdge(cages.back().second, 0, 1, 10);
      cages.push_back({"cone", fan(faces, true, 5)});
      sharpenVertex(cages.back().second, 0, 10);
      cages.push_back({"semi-sharp", perturbed(fan(faces, true, 8), 0.1, 1)});
      sharpenEdge(cages.back().second, 0, 1, 2);
    }
    for (const auto& [kind, cage] : cages) {
      const std::string name = std::to_string(faces) + " faces, " + kind;
      std::vector<Location> at;
      for (const int face : std::set<int>{0, 1 % faces, faces / 2, faces - 1}) {
        at += shells(4 * face, 0, {1, 4, 8, 9, 10, 14, 20, 28, 40});
      }
      worst = std::max(worst, compare(name, cage, at));
    }
  }
  std::printf("  worst relative to the larger principal curvature: %.1e\n", worst);
}

TEST(Curvature, KeepsItsDigitsBesideIrregularVertices) { compareRings({1, 2, 3, 4, 5, 8, 64}); }

TEST(SlowCurvature, KeepsItsDigitsBesideIrregularVertices) {
  std::vector<int> numbers;
  for (int faces = 1; faces <= 33; ++faces) numbers.push_back(faces);
  for (const int faces : {40, 48, 63, 64}) numbers.push_back(faces);
  compareRings(numbers);
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
  struct Place {
    TrueCurvature curvature;
    Vector3 normal;
  };
  std::vector<Place> places;
  Vector3 normal = Vector3::Zero();
  for (int face = 0; face < static_cast<int>(cage.faces.size()); face += 4) {
    for (const auto& [u, v] : {std::pair{1., 0.25}, {1., 0.75}, {0.75, 1.}, {0.25, 1.}}) {
      const Location at = {face, radius * u, radius * v};
      places.push_back({deep.curvature(at), deep.evaluate(at)[kNormal]});
      normal += places.back().curvature.area * places.back().normal;
    }
  }
  normal = vertex_normal.hasNaN() ? normal.normalized() : vertex_normal;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double total = 0;
  size = 0;
  for (const auto& [k, there] : places) {
    const Vector3 d1 = k.direction1, d2 = there.cross(d1);
    const Eigen::Matrix3d turn = rotationBetween(there, normal);
    const Eigen::Matrix3d shape = k.k1 * d1 * d1.transpose() + k.k2 * d2 * d2.transpose();
    sum += k.area * turn * shape * turn.transpose();
    total += k.area;
    size = std::max(size, sizeOf(k));
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
    for (const double radius : {0.5, 1. / 8, kCurvatureRadius, 0x1p-12, 0x1p-40}) {
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
      EXPECT_LE(error, kCurvatureError) << where;
    }
  }
  std::printf("  worst relative to the larger principal curvatures: %.1e\n", worst);
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
