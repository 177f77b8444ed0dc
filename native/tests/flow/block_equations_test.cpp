// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/flow/block_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Equations whose solution minimizes squares of x_i - R x_j, for random pairs and random R that
/// turn and stretch vectors. The same are added to a dense matrix.
struct Example {
  Example(bool mirrors, double rest) : blocks(kVertices) {
    Random random(4);
    for (int pair = 0; pair < 3 * kVertices; ++pair) {
      const int i = random.below(kVertices), j = (i + 1 + random.below(kVertices - 1)) % kVertices;
      const double angle = random.uniform(0, 6), size = random.uniform(0.5, 2);
      Eigen::Matrix2d turn;
      turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
      turn *= size;
      if (mirrors && pair % 5 == 0) {
        turn.col(1) *= -1;
      }
      add(i, i, Eigen::Matrix2d::Identity());
      add(j, j, turn.transpose() * turn);
      add(i, j, -turn);
      add(j, i, -turn.transpose());
    }
    for (int i = 0; i < kVertices; ++i) {
      add(i, i, rest * Eigen::Matrix2d::Identity());
    }
    for (double& number : right) {
      number = random.uniform(-1, 1);
    }
  }

  void add(int row, int column, const Eigen::Matrix2d& values) {
    blocks.add(row, column, values);
    dense.block<2, 2>(2 * row, 2 * column) += values;
  }

  static constexpr int kVertices = 60;
  BlockEquations blocks;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(2 * kVertices, 2 * kVertices);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * kVertices);
};

TEST(BlockEquations, HaveTheSolutionOfTheDenseSystem) {
  for (const bool mirrors : {false, true}) {
    SCOPED_TRACE(mirrors);
    const Example example(mirrors, 0.1);
    const auto found = example.blocks.solve(example.right);
    ASSERT_TRUE(found);
    const Eigen::VectorXd expected = example.dense.ldlt().solve(example.right);
    EXPECT_LT((*found - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST(BlockEquations, WithoutASolutionGiveNone) {
  for (const bool mirrors : {false, true}) {
    BlockEquations blocks(2);
    blocks.add(0, 0, Eigen::Matrix2d::Identity());
    if (mirrors) {
      blocks.add(1, 1, Eigen::Vector2d(1, -1).asDiagonal().toDenseMatrix());
      blocks.add(1, 1, Eigen::Vector2d(-1, 1).asDiagonal().toDenseMatrix());
    }
    EXPECT_FALSE(blocks.solve(Eigen::VectorXd::Ones(4)));
  }
}

}  // namespace
}  // namespace limitsurf::test
