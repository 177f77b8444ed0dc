// SPDX-License-Identifier: Apache-2.0
//
// Evaluation keeps its bounds on golden values of the true limit surface.
#include "support/truth/golden.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "support/truth/accuracy.h"
#include "support/truth/corner_points.h"

namespace limitsurf::test {
namespace {

class GoldenValues : public testing::TestWithParam<std::string> {};

TEST_P(GoldenValues, AreReached) {
  const Golden golden = readGolden(GetParam());
  const LimitSurface surface = limitSurface(golden.cage);
  const CornerPoints corners(golden.cage);

  Accuracy accuracy(golden.name, diagonal(golden.cage.positions));
  for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
    accuracy.addScale(golden.at[i], truthOf(golden, i));
  }
  for (Derivatives order : kOrders) {
    const Evaluation evaluation = surface.evaluate(golden.at, order, order != Derivatives::none);
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      Truth truth = upTo(order, truthOf(golden, i));
      if (corners.insideSmoothCorner(golden.at[i])) truth.values[kNormal].setConstant(NAN);
      accuracy.check(golden.at[i], rowOf(evaluation, i), truth);
    }
  }
  std::printf("%s\n", accuracy.summary().c_str());
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    char figure[20];
    std::snprintf(figure, sizeof figure, "%.2e", accuracy.worst(quantity));
    RecordProperty(kQuantityNames[quantity], figure);
  }
}

TEST_P(GoldenValues, AreMissingWhereThereIsNoLimit) {
  const Golden golden = readGolden(GetParam());
  const LimitSurface surface = limitSurface(golden.cage);
  const CornerPoints corners(golden.cage);
  for (Derivatives order : {Derivatives::first, Derivatives::second}) {
    const Evaluation evaluation = surface.evaluate(golden.at, order, true);
    const int quantities[] = {kPosition, kDu, kDv, kNormal, kDuu, kDuv, kDvv};
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      const Truth got = rowOf(evaluation, i), truth = truthOf(golden, i);
      for (int quantity : quantities) {
        if (order == Derivatives::first && quantity == kDuu) break;
        const auto where = [&] {
          return golden.name + ", " + describe(golden.at[i]) + ": " + kQuantityNames[quantity];
        };
        if (!truth[quantity].hasNaN()) {
          EXPECT_TRUE(got[quantity].allFinite()) << where();
          continue;
        }
        const CornerPoint* corner = corners.at(golden.at[i]);
        ASSERT_TRUE(corner != nullptr && !corner->regular()) << where();
        const bool first = quantity == kDu || quantity == kDv;
        if (first && corner->isFlat()) {
          EXPECT_EQ(got[quantity], Vector3::Zero()) << where() << " around two or three faces";
        } else {
          EXPECT_TRUE(got[quantity].array().isNaN().all())
              << where() << " has no limit, but is " << got[quantity].transpose();
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenValues, testing::ValuesIn(goldenNames()),
                         [](const auto& test) { return test.param; });

TEST(GoldenData, IsComplete) {
  int meshes = 0, sharp = 0;
  long samples = 0;
  for (const std::string& name : goldenNames()) {
    const Golden golden = readGolden(name);
    ++meshes;
    sharp += golden.hasSharpness();
    samples += static_cast<long>(golden.at.size());
  }
  EXPECT_EQ(meshes, 78);
  EXPECT_EQ(sharp, 28);
  EXPECT_EQ(samples, 22468);
}

}  // namespace
}  // namespace limitsurf::test
