// SPDX-License-Identifier: Apache-2.0
//
// The witness of the other tests, held against the golden values and OpenSubdiv before it is
// believed.
#include "support/truth/deep_subdivision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/corner_points.h"
#include "support/truth/far_limit.h"
#include "support/truth/golden.h"

namespace limitsurf::test {
namespace {

/// Compares one in `step` of the values of a mesh, and all where there are few.
void compareWithGoldenValues(int step) {
  constexpr int kFew = 100;
  Accuracy all("deep subdivision", 1);
  for (const std::string& name : goldenNames()) {
    const Golden golden = readGolden(name);
    DeepSubdivision deep(golden.cage);
    const CornerPoints corners(golden.cage);
    Accuracy accuracy(name, diagonal(golden.cage.positions));
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      accuracy.addScale(golden.at[i], truthOf(golden, i));
    }
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      const CornerPoint* corner = corners.at(golden.at[i]);
      if (corner != nullptr && !corner->regular()) continue;
      if (i % step != 0 && golden.at.size() > kFew) continue;
      accuracy.check(golden.at[i], deep.evaluate(golden.at[i]), truthOf(golden, i));
    }
    all.merge(accuracy);
  }
  std::printf("%s", all.details().c_str());
  for (int q = 0; q < kQuantities; ++q) {
    EXPECT_LE(all.worst(q), 4e-16) << kQuantityNames[q];  // both are rounded once
  }
}

TEST(DeepSubdivision, AgreesWithGoldenValues) { compareWithGoldenValues(18); }

TEST(SlowDeepSubdivision, AgreesWithGoldenValues) { compareWithGoldenValues(1); }

TEST(DeepSubdivision, FindsLimitsOfIrregularVertices) {
  Accuracy all("irregular vertices", 1);
  for (const std::string& name : goldenNames()) {
    const Golden golden = readGolden(name);
    if (golden.at.size() > 400) continue;  // to save time
    DeepSubdivision deep(golden.cage);
    const CornerPoints corners(golden.cage);
    Accuracy accuracy(name, diagonal(golden.cage.positions));
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      accuracy.addScale(golden.at[i], truthOf(golden, i));
    }
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      const Location& at = golden.at[i];
      const CornerPoint* corner = corners.at(at);
      if (corner == nullptr || corner->regular()) continue;
      Truth truth = truthOf(golden, i);
      EXPECT_EQ(truth[kNormal].hasNaN(), !corner->hasNormal()) << name << ", " << describe(at);
      truth.values[kNormal].setConstant(NAN);  // its value is not known to the witness
      const Truth limit = deep.corner(at.face, cornerAt(at));
      for (int q = kDu; q <= kDvv; ++q) {
        if (!limit[q].hasNaN() && limit[q].isZero()) continue;  // golden values have none there
        EXPECT_EQ(limit[q].hasNaN(), truth[q].hasNaN()) << name << ", " << describe(at) << q;
      }
      accuracy.check(at, limit, truth);
    }
    all.merge(accuracy);
  }
  std::printf("%s", all.details().c_str());
  for (int q = 0; q < kNormal; ++q) EXPECT_LE(all.worst(q), 4e-16) << kQuantityNames[q];
}

/// Holds the witness against OpenSubdiv's uniform refinement and limit masks where these are right:
/// at all corners of faces, and at one in `step` of the other points.
void compareWithFar(const std::string& name, const Cage& cage, int step, double& worst) {
  DeepSubdivision deep(cage);
  const CornerPoints corners(cage);
  const FarLimit far = farLimit(cage, 4);
  for (int i = 0; i < static_cast<int>(far.at.size()); ++i) {
    const CornerPoint* corner = corners.at(far.at[i]);
    if (corner == nullptr && i % step != 0) continue;
    if (corner != nullptr && corner->rule == Rule::dart) continue;
    if (corner != nullptr && corner->rule == Rule::smooth && corner->faces == 2) continue;
    const Vector3 truth = corner != nullptr
                              ? deep.cornerPosition(far.at[i].face, cornerAt(far.at[i]))
                              : deep.evaluate(far.at[i])[kPosition];
    const double error =
        (truth - far.position.row(i).transpose()).norm() / diagonal(cage.positions);
    worst = std::max(worst, error);
    ASSERT_LE(error, 2e-15) << name << ", " << describe(far.at[i]);
  }
}

void compareNonManifoldMeshes(int step) {
  double worst = 0;
  NamedCages cages = nonManifoldCages();
  for (auto& cage : fansOnACrease()) cages.push_back(std::move(cage));
  for (auto& [name, cage] : cages) {
    for (const Boundary boundary : {Boundary::smooth, Boundary::corners}) {
      cage.options.boundary = boundary;
      compareWithFar(name, cage, step, worst);
    }
  }
  std::printf("  worst %.2e\n", worst);
}

TEST(DeepSubdivision, AgreesWithOpenSubdivOnNonManifoldMeshes) { compareNonManifoldMeshes(199); }

TEST(SlowDeepSubdivision, AgreesWithOpenSubdivOnNonManifoldMeshes) { compareNonManifoldMeshes(17); }

void compareSharpMeshes(int mixtures, int step) {
  // Sharpness that has decayed after four levels, also under Chaikin's rule, and that this never
  // takes from above 1 to 0, where OpenSubdiv extrapolates. Sums of these values are exact in
  // single precision, so that the order in which OpenSubdiv adds them does not matter.
  double worst = 0;
  Random random(5);
  NamedCages cages = nonManifoldCages();
  for (int seed = 1; seed <= mixtures; ++seed) {
    cages.emplace_back("mixture " + std::to_string(seed), mixture(seed));
  }
  for (auto& [name, plain] : cages) {
    for (const Creasing creasing : {Creasing::uniform, Creasing::chaikin}) {
      const bool uniform = creasing == Creasing::uniform;
      Cage cage = plain;
      cage.options.creasing = creasing;
      const std::vector<double> uniform_values = {0.375, 1, 1.5, 2.75, 3, 4, INFINITY};
      sharpenAtRandom(cage, random, 3, 5, uniform ? uniform_values : std::vector{0.5, 0.75, 10.0});
      compareWithFar(name + (uniform ? ", uniform" : ", chaikin"), cage, step, worst);
    }
  }
  std::printf("  worst %.2e\n", worst);
}

TEST(DeepSubdivision, AgreesWithOpenSubdivOnSharpMeshes) { compareSharpMeshes(4, 199); }

TEST(SlowDeepSubdivision, AgreesWithOpenSubdivOnSharpMeshes) { compareSharpMeshes(10, 17); }

}  // namespace
}  // namespace limitsurf::test
