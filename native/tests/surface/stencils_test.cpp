// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

std::vector<Location> places(const Cage& cage) {
  Random random(3);
  return everywhere(cage, {1, 4, 9, 30}, 3, random);
}

std::vector<Cage> someCages() {
  std::vector<Cage> cages = {cross(),         cube(),           prism(5, true),
                             fan(7, true, 1), fan(6, false, 2), ngon(6, 3),
                             mixture(4),      mixture(5),       valenceTwo()};
  const std::size_t count = cages.size();
  for (std::size_t i = 0; i < count; ++i) {
    Cage pinned = cages[i];
    pinned.options.boundary = Boundary::corners;
    cages.push_back(pinned);
  }
  return cages;
}

/// The sum of the positions with the weights of row `row`.
Vector3 combined(const Stencils& stencils, const LargePageVector<double>& weights, int row,
                 const Points& positions) {
  Vector3 sum = Vector3::Zero();
  for (std::int64_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k) {
    sum += weights[k] * positions.row(stencils.indices[k]).transpose();
  }
  return sum;
}

double total(const Stencils& stencils, const LargePageVector<double>& weights, int row) {
  return std::accumulate(weights.begin() + stencils.offsets[row],
                         weights.begin() + stencils.offsets[row + 1], 0.0);
}

double totalMagnitude(const Stencils& stencils, const LargePageVector<double>& weights, int row) {
  double sum = 0;
  for (std::int64_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k) {
    sum += std::abs(weights[k]);
  }
  return sum;
}

TEST(Stencils, AreWellFormed) {
  for (const Cage& cage : someCages()) {
    const std::vector<Location> at = places(cage);
    const Stencils stencils = limitSurface(cage).stencils(at, true);
    ASSERT_EQ(stencils.offsets.size(), at.size() + 1);
    EXPECT_EQ(stencils.offsets.front(), 0);
    EXPECT_EQ(stencils.offsets.back(), static_cast<std::int64_t>(stencils.indices.size()));
    EXPECT_EQ(stencils.weights.size(), stencils.indices.size());
    EXPECT_EQ(stencils.du_weights.size(), stencils.indices.size());
    EXPECT_EQ(stencils.dv_weights.size(), stencils.indices.size());
    for (std::size_t row = 0; row < at.size(); ++row) {
      ASSERT_LT(stencils.offsets[row], stencils.offsets[row + 1]) << describe(at[row]);
      std::set<int> seen;
      for (std::int64_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k) {
        const int index = stencils.indices[k];
        EXPECT_TRUE(index >= 0 && index < cage.vertexCount()) << describe(at[row]);
        EXPECT_TRUE(seen.insert(index).second)
            << describe(at[row]) << " names vertex " << index << " twice";
      }
    }
  }
}

TEST(Stencils, PartitionUnity) {
  for (const Cage& cage : someCages()) {
    const std::vector<Location> at = places(cage);
    const Stencils stencils = limitSurface(cage).stencils(at, true);
    for (int row = 0; row < static_cast<int>(at.size()); ++row) {
      EXPECT_NEAR(total(stencils, stencils.weights, row), 1, 1e-13) << describe(at[row]);
      for (const auto* weights : {&stencils.du_weights, &stencils.dv_weights}) {
        const double sum = total(stencils, *weights, row);
        if (std::isnan(sum)) continue;
        EXPECT_LE(std::abs(sum), 1e-12 * std::max(1.0, totalMagnitude(stencils, *weights, row)))
            << describe(at[row]);
      }
    }
  }
}

TEST(Stencils, TimesTheCageAreTheEvaluation) {
  for (const Cage& cage : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    const Stencils stencils = surface.stencils(at, true);
    const Evaluation evaluation = surface.evaluate(at, Derivatives::first);
    const double size = diagonal(cage.positions);
    for (int row = 0; row < static_cast<int>(at.size()); ++row) {
      const Vector3 position = combined(stencils, stencils.weights, row, cage.positions);
      EXPECT_LE((position - evaluation.position.row(row).transpose()).norm(), kPositionError * size)
          << describe(at[row]);
      const auto compare = [&](const LargePageVector<double>& weights, const Points& derivatives) {
        const Vector3 expected = derivatives.row(row);
        const Vector3 got = combined(stencils, weights, row, cage.positions);
        if (expected.hasNaN()) {
          EXPECT_TRUE(got.hasNaN()) << describe(at[row]);
          return;
        }
        EXPECT_LE((got - expected).norm(), kFirstDerivativeError * std::max(size, expected.norm()))
            << describe(at[row]);
      };
      compare(stencils.du_weights, evaluation.du);
      compare(stencils.dv_weights, evaluation.dv);
    }
  }
}

TEST(Stencils, DependOnTopologyAlone) {
  const Cage cage = mixture(8);
  const std::vector<Location> at = places(cage);
  const Stencils one = limitSurface(cage).stencils(at, true);
  const Stencils other = limitSurface(perturbed(cage, 5, 1)).stencils(at, true);
  EXPECT_EQ(one.offsets, other.offsets);
  EXPECT_EQ(one.indices, other.indices);
  EXPECT_EQ(one.weights, other.weights);
}

TEST(Stencils, WithoutDerivativesHaveTheSameWeights) {
  const Cage cage = mixture(9);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = places(cage);
  const Stencils with = surface.stencils(at, true), without = surface.stencils(at);
  ASSERT_EQ(with.indices, without.indices);
  for (std::size_t k = 0; k < with.weights.size(); ++k) {
    EXPECT_NEAR(with.weights[k], without.weights[k], 1e-15);  // equal bits are not promised here
  }
  EXPECT_TRUE(without.du_weights.empty());
  EXPECT_TRUE(without.dv_weights.empty());
}

TEST(Stencils, OfABoundaryCurveUseBoundaryVerticesAlone) {
  const Cage cage = fan(9, false, 3);
  const LimitSurface surface = limitSurface(cage);
  const std::set<int> boundary = {cage.faces[0][0], cage.faces[0][1], cage.faces[1][1],
                                  cage.faces[4 * 8][3], cage.faces[4 * 8 + 2][3]};
  std::vector<Location> at;
  for (double u : {0.0, 1e-12, 0.01, 0.25, 0.7, 1.0}) at.push_back({0, u, 0});
  const Stencils stencils = surface.stencils(at);
  for (std::size_t k = 0; k < stencils.indices.size(); ++k) {
    if (boundary.count(stencils.indices[k]) == 0) {
      EXPECT_EQ(stencils.weights[k], 0) << "vertex " << stencils.indices[k];
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
