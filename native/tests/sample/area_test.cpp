// SPDX-License-Identifier: Apache-2.0
//
// Areas of surfaces on which a quadrature could go on for ever, and what is stated of their errors.
#include "limitsurf/sample/area.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/cages/meshes.h"

namespace limitsurf::test {
namespace {

/// No tile takes more evaluations than this at first: cores take 66 for each patch of at most 72
/// steps, or 130 where so many promise to be enough, and far fewer on ordinary meshes.
constexpr std::int64_t kMostFirst = 66 * 3 * 72;
/// All squares that refinement makes, if it takes up fewer than 2048 tiles: 66 places each.
constexpr std::int64_t kMostRefined = std::int64_t{66} << 17;

/// |du x dv| integrated over all faces, by Gauss's rule with two points on `cells` x `cells`
/// squares of each face.
double integrated(const LimitSurface& surface, int cells) {
  const double half = 0.5, off = 0.28867513459481287;
  std::vector<Location> at;
  double sum = 0;
  for (int face = 0; face < surface.faceCount(); ++face) {
    at.clear();
    for (int j = 0; j < 2 * cells; ++j) {
      for (int i = 0; i < 2 * cells; ++i) {
        const double u = (i / 2 + half + (i % 2 ? off : -off)) / cells;
        const double v = (j / 2 + half + (j % 2 ? off : -off)) / cells;
        at.push_back({face, u, v});
      }
    }
    const Evaluation e = surface.evaluate(at, Derivatives::first);
    double of_face = 0;
    for (int i = 0; i < e.du.rows(); ++i) {
      const Vector3 du = e.du.row(i), dv = e.dv.row(i);
      of_face += du.cross(dv).norm();
    }
    sum += of_face / static_cast<double>(at.size());
  }
  return sum;
}

/// A plane mesh whose faces are partly turned over.
Cage folded(int columns, int rows, double size, std::uint64_t seed) {
  Cage cage = perturbed(grid(columns, rows), size, seed);
  cage.positions.col(2).setZero();
  return cage;
}

TEST(Area, OfSmoothSurfacesIsExact) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const LimitSurface surface = limitSurface(perturbed(torus(7, 5), 0.05, seed));
    const double fine = integrated(surface, 64), coarse = integrated(surface, 32);
    // The rule's error falls by a factor of 16.
    const double truth = fine + (fine - coarse) / 15;
    const SurfaceArea area = measuredArea(surface);
    EXPECT_LE(std::abs(area.value - truth), 5e-9 * truth);
    EXPECT_LE(area.error, kAreaError * truth);
  }
}

TEST(Area, ScalesWithPowersOfTwo) {
  for (const Cage& cage : {cube(), prism(5, true), perturbed(pole(7), 0.1, 1)}) {
    const SurfaceArea unit = measuredArea(limitSurface(cage));
    EXPECT_LE(unit.error, kAreaError * unit.value);
    for (const int exponent : {-260, -100, 30, 266}) {
      const SurfaceArea area = measuredArea(limitSurface(placed(cage, std::ldexp(1., exponent))));
      EXPECT_NEAR(std::ldexp(area.value, -2 * exponent), unit.value, 1e-12 * unit.value)
          << exponent;
      EXPECT_LE(area.error, kAreaError * area.value) << exponent;
    }
  }
}

TEST(Area, OfFacesOnALineIsZero) {
  Cage cage = grid(1, 1);
  const double at[4] = {0, 1, 1.37, 0.37};
  for (int vertex = 0; vertex < 4; ++vertex) {
    cage.positions.row(vertex) = at[vertex] * Vector3(0.3, 0.7, 0.11);
  }
  const SurfaceArea area = measuredArea(limitSurface(cage));
  EXPECT_LE(area.value, area.error);
  EXPECT_LE(area.error, 1e-13);
  EXPECT_LE(area.evaluations, 4 * (kMostFirst + 66 * 64));
}

TEST(Area, OfFoldedPlanesHasAStatedError) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const LimitSurface surface = limitSurface(folded(3, 3, 0.2 + 0.1 * seed, seed));
    const double fine = integrated(surface, 200), coarse = integrated(surface, 100);
    const SurfaceArea area = measuredArea(surface);
    EXPECT_LE(std::abs(area.value - fine), area.error + 2 * std::abs(fine - coarse) + 1e-6 * fine)
        << seed;
    EXPECT_LE(area.error, 1e-5 * area.value) << seed;
    EXPECT_LE(area.evaluations, 9 * kMostFirst + kMostRefined) << seed;
  }
}

/// Small folds in the corners of faces lie between the points of a rule, all of which then agree.
TEST(Area, FindsFoldsBetweenThePointsOfARule) {
  Cage cage = grid(3, 3);
  // The middle face's vertex is moved beyond the opposite one, so that a corner turns over.
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    if (cage.positions.row(vertex).head<2>() == Eigen::RowVector2d(1, 1)) {
      cage.positions.row(vertex) = Vector3(1.62, 1.6, 0);
    }
  }
  const LimitSurface surface = limitSurface(cage);
  const double fine = integrated(surface, 400);
  EXPECT_NEAR(measuredArea(surface).value, fine, 2e-7 * fine);
}

// Around one of the vertices the surface turns over within some levels, and back again in deeper
// ones. Alone, each face has too few cores of a kind for an integral over whole cores
// (coreNormal()).
TEST(Area, FindsFoldsWithinCores) {
  Cage cage = inTriangles(perturbed(grid(4, 4), 3, 66));
  cage.positions.col(2).setZero();
  const SurfaceArea whole = measuredArea(limitSurface(cage));
  const int faces = static_cast<int>(cage.faces.size());
  double sum = 0, error = whole.error;
  for (int face = 0; face < faces; ++face) {
    Cage alone = cage;
    for (int other = 0; other < faces; ++other) {
      if (other != face) {
        alone.options.holes.push_back(other);
      }
    }
    const SurfaceArea part = measuredArea(limitSurface(alone));
    sum += part.value;
    error += part.error;
  }
  EXPECT_LE(error, 1e-7 * sum);
  EXPECT_NEAR(whole.value, sum, 3 * error);
}

TEST(Area, CostIsBoundedOnManyFoldedFaces) {
  const SurfaceArea area = measuredArea(limitSurface(folded(40, 40, 0.6, 3)));
  EXPECT_LE(area.evaluations, kMostRefined + 1600 * 300);
  EXPECT_LE(area.error, 1e-4 * area.value);
}

TEST(Area, OfTrianglesTakesFewEvaluations) {
  const Cage quads = perturbed(grid(20, 20), 0.05, 7);
  Cage triangles = quads;
  triangles.faces.clear();
  for (const std::vector<int>& f : quads.faces) {
    triangles.faces.push_back({f[0], f[1], f[2]});
    triangles.faces.push_back({f[0], f[2], f[3]});
  }
  const SurfaceArea area = measuredArea(limitSurface(triangles));
  EXPECT_LE(area.error, kAreaError * area.value);
  // 12 tiles for each triangle, 6 of which are cores.
  EXPECT_LE(area.evaluations, 800 * 12 * 800);
  EXPECT_LE(measuredArea(limitSurface(quads)).evaluations, 400 * 130);
}

/// One rule of 8 points a side is enough where quarters with 6 each took twice as many.
TEST(Area, OfUnevenQuadsTakesOneRuleForMost) {
  Cage cage = perturbed(grid(40, 40), 0.1, 1);
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    auto p = cage.positions.row(vertex);
    p[2] = std::sin(0.9 * p[0]) * std::sin(p[1]);
  }
  EXPECT_LE(measuredArea(limitSurface(cage)).evaluations, 1600 * 150);
}

TEST(Area, HasTheSameBitsWithAllInstructionSets) {
  const InstructionSet before = instructionSet();
  const LimitSurface even = limitSurface(perturbed(pole(7), 0.1, 1)),
                     surface = limitSurface(folded(5, 5, 0.5, 1));
  useInstructionSet(InstructionSet::baseline);
  const SurfaceArea first = measuredArea(even), second = measuredArea(surface);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!isAvailable(set)) continue;
    useInstructionSet(set);
    const SurfaceArea same_first = measuredArea(even), same_second = measuredArea(surface);
    EXPECT_EQ(first.value, same_first.value);
    EXPECT_EQ(first.error, same_first.error);
    EXPECT_EQ(second.value, same_second.value);
    EXPECT_EQ(second.error, same_second.error);
    EXPECT_EQ(second.evaluations, same_second.evaluations);
  }
  useInstructionSet(before);
}

TEST(Area, DoesNotDependOnThreads) {
  const LimitSurface surface = limitSurface(folded(6, 6, 0.5, 1));
  const SurfaceArea one = measuredArea(surface, 1), many = measuredArea(surface, 0);
  EXPECT_EQ(one.value, many.value);
  EXPECT_EQ(one.error, many.error);
  EXPECT_EQ(one.evaluations, many.evaluations);
}

}  // namespace
}  // namespace limitsurf::test
