// SPDX-License-Identifier: Apache-2.0
//
// Positions and normals against OpenSubdiv's limit masks on uniformly refined meshes, where these
// are right.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"
#include "support/truth/accuracy.h"
#include "support/truth/corner_points.h"
#include "support/truth/far_limit.h"

namespace limitsurf::test {
namespace {

constexpr int kLevel = 4;
// The rounding of OpenSubdiv's own refinement in double over four levels.
constexpr double kFarError = 2e-15;
constexpr double kFarNormalError = 1e-11;

struct Worst {
  double position = 0, normal = 0;
};

void compare(const std::string& name, const Cage& cage, Worst& worst) {
  const LimitSurface surface = limitSurface(cage);
  const FarLimit far = farLimit(cage, kLevel);
  const Evaluation evaluation = surface.evaluate(far.at, Derivatives::first, true);
  const CornerPoints corners(cage);
  const double size = diagonal(cage.positions);
  for (int i = 0; i < static_cast<int>(far.at.size()); ++i) {
    const CornerPoint* corner = corners.at(far.at[i]);
    const bool valence_two =
        corner != nullptr && corner->rule == Rule::smooth && corner->faces == 2;
    if (valence_two) continue;
    const double error = (evaluation.position.row(i) - far.position.row(i)).norm() / size;
    worst.position = std::max(worst.position, error);
    EXPECT_LE(error, kPositionError + kFarError) << name << ", " << describe(far.at[i]);

    const bool on_edge =
        far.at[i].u == 0 || far.at[i].u == 1 || far.at[i].v == 0 || far.at[i].v == 1;
    const bool interior_vertex = corner != nullptr && corner->rule == Rule::smooth;
    if (on_edge && !interior_vertex) continue;  // boundaries have masks of their own
    const Vector3 t1 = far.tangent1.row(i), t2 = far.tangent2.row(i);
    const Vector3 cross = t1.cross(t2);
    if (cross.norm() < 1e-3 * t1.norm() * t2.norm()) continue;
    const double turned = angle(evaluation.normal.row(i), cross.normalized());
    worst.normal = std::max(worst.normal, turned);
    EXPECT_LE(turned, kNormalError + kFarNormalError) << name << ", " << describe(far.at[i]);
  }
}

void compareUnderAllRules(const std::string& name, Cage cage, Worst& worst) {
  for (Boundary boundary : {Boundary::smooth, Boundary::corners}) {
    for (Triangles triangles : {Triangles::catmark, Triangles::smooth}) {
      cage.options.boundary = boundary;
      cage.options.triangles = triangles;
      compare(name, cage, worst);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(OpenSubdiv, AgreesOnOpenMeshes) {
  Worst worst;
  compareUnderAllRules("cross", cross(), worst);
  compareUnderAllRules("grid", perturbed(grid(4, 3), 0.2, 1), worst);
  compareUnderAllRules("holes", perturbed(gridWithHoles(6, 5, {7, 9, 17, 22}), 0.2, 2), worst);
  compareUnderAllRules("bow-tie", perturbed(gridWithHoles(5, 5, {7, 13}), 0.2, 2), worst);
  compareUnderAllRules("tube", perturbed(prism(6, false), 0.2, 3), worst);
  std::printf("  worst position %.2e, normal %.2e\n", worst.position, worst.normal);
}

TEST(OpenSubdiv, AgreesOnClosedMeshes) {
  Worst worst;
  compareUnderAllRules("cube", cube(), worst);
  compareUnderAllRules("tetrahedron", perturbed(tetrahedron(), 0.2, 4), worst);
  compareUnderAllRules("torus", torus(8, 5), worst);
  for (int sides : {3, 4, 5, 7, 11}) {
    compareUnderAllRules("prism", perturbed(prism(sides, true), 0.2, sides), worst);
  }
  std::printf("  worst position %.2e, normal %.2e\n", worst.position, worst.normal);
}

TEST(OpenSubdiv, AgreesOnRandomMixtures) {
  Worst worst;
  for (int seed = 1; seed <= 20; ++seed) {
    compareUnderAllRules("mixture " + std::to_string(seed), mixture(seed), worst);
  }
  std::printf("  worst position %.2e, normal %.2e\n", worst.position, worst.normal);
}

TEST(OpenSubdiv, AgreesOnSharpMixtures) {
  // The sharpness has decayed when OpenSubdiv's limit masks are applied.
  Random random(1);
  double worst = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    Cage cage = mixture(seed);
    sharpenAtRandom(cage, random, 3, 5, {0.3, 1, 1.5, 2.75, 3, 4, 10});
    const LimitSurface surface = limitSurface(cage);
    const FarLimit far = farLimit(cage, kLevel);
    const Points position = surface.evaluate(far.at).position;
    const CornerPoints corners(cage);
    for (int i = 0; i < static_cast<int>(far.at.size()); ++i) {
      const CornerPoint* corner = corners.at(far.at[i]);
      const bool wrong_mask =
          corner != nullptr &&
          (corner->rule == Rule::dart || (corner->rule == Rule::smooth && corner->faces == 2));
      if (wrong_mask) continue;
      const double error =
          (position.row(i) - far.position.row(i)).norm() / diagonal(cage.positions);
      worst = std::max(worst, error);
      ASSERT_LE(error, kPositionError + kFarError) << seed << ", " << describe(far.at[i]);
    }
  }
  std::printf("  worst position %.2e\n", worst);
}

TEST(OpenSubdiv, AgreesAroundHighValences) {
  Worst worst;
  for (int faces : {3, 5, 9, 20, 60}) {
    compareUnderAllRules("closed fan", fan(faces, true, faces), worst);
    compareUnderAllRules("open fan", fan(faces, false, faces), worst);
    compareUnderAllRules("polygon", ngon(faces, faces), worst);
  }
  std::printf("  worst position %.2e, normal %.2e\n", worst.position, worst.normal);
}

}  // namespace
}  // namespace limitsurf::test
