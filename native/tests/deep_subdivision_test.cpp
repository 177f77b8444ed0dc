// SPDX-License-Identifier: Apache-2.0
//
// The witness of the other tests, held against the golden values before it is believed.
#include "support/deep_subdivision.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "support/golden.h"

namespace limitsurf::test {
namespace {

TEST(DeepSubdivision, AgreesWithGoldenValues) {
  Accuracy all("deep subdivision", 1);
  for (const std::string& name : goldenNames()) {
    const Golden golden = readGolden(name);
    if (golden.hasSharpness()) continue;
    DeepSubdivision deep(golden.cage);
    const CornerPoints corners(golden.cage);
    Accuracy accuracy(name, diagonal(golden.cage.positions));
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      accuracy.addScale(golden.at[i], truthOf(golden, i));
    }
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      const CornerPoint* corner = corners.at(golden.at[i]);
      if (corner != nullptr && !corner->regular()) continue;
      if (i % 2 != 0 && golden.at.size() > 300) continue;  // to save time
      accuracy.check(golden.at[i], deep.evaluate(golden.at[i]), truthOf(golden, i));
    }
    all.merge(accuracy);
  }
  std::printf("%s", all.details().c_str());
  for (int q = 0; q < kQuantities; ++q) {
    EXPECT_LE(all.worst(q), 4e-16) << kQuantityNames[q];  // both are rounded once
  }
}

TEST(DeepSubdivision, FindsLimitsOfIrregularVertices) {
  double worst = 0;
  for (const std::string& name : goldenNames()) {
    const Golden golden = readGolden(name);
    if (golden.hasSharpness()) continue;
    if (golden.at.size() > 400) continue;  // to save time
    DeepSubdivision deep(golden.cage);
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      for (int corner = 0; corner < 4; ++corner) {
        const Location there = cornerLocation(golden.at[i].face, corner);
        if (golden.at[i].u != there.u || golden.at[i].v != there.v) continue;
        const Vector3 truth = golden.values[kPosition].row(i);
        const double error = (deep.cornerPosition(there.face, corner) - truth).norm() /
                             diagonal(golden.cage.positions);
        worst = std::max(worst, error);
        EXPECT_LE(error, 4e-16) << name << ", " << describe(there);
      }
    }
  }
  std::printf("  worst %.2e\n", worst);
}

}  // namespace
}  // namespace limitsurf::test
