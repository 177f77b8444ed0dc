// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_turns.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "support/random.h"
#include "support/truth/decompositions.h"

namespace limitsurf::test {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Matrix matrixOf(const Rotations& rotations, Eigen::Index row) {
  return Eigen::Map<const Matrix>(rotations.row(row).data());
}

Matrix turnBetween(const Vector3& from, const Vector3& to) {
  return matrixOf(shortestTurns(from.transpose(), to.transpose()), 0);
}

TEST(StrandTurns, TurnByTheSmallestAngle) {
  Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vector3 from = random.vector(3), to = random.vector(0.1);
    const Matrix turn = turnBetween(from, to);
    const double sum = (from.normalized() + to.normalized()).norm(), bound = kTurnError / sum;
    // An error of each entry makes one of each coordinate that is at most sqrt(3) times as large.
    EXPECT_LE((turn * from.normalized() - to.normalized()).cwiseAbs().maxCoeff(),
              std::sqrt(3) * bound);
    // The errors of the other rotation, made from the angle's cosine, grow with the square.
    EXPECT_LE((turn - rotationBetween(from, to)).cwiseAbs().maxCoeff(),
              bound + 1e-15 / (sum * sum));
    EXPECT_NEAR(turn.determinant(), 1, 10 * bound);
  }
}

TEST(StrandTurns, TurnOppositeVectorsAboutAPerpendicularAxis) {
  for (const Vector3& from : {Vector3(1, 0, 0), Vector3(0, -2, 0), Vector3(1, 2, -3)}) {
    const Matrix turn = turnBetween(from, -from);
    EXPECT_LE((turn * from + from).norm(), 1e-14 * from.norm());
    EXPECT_LE((turn * turn - Matrix::Identity()).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_NEAR(turn.determinant(), 1, 1e-14);
  }
}

TEST(StrandTurns, AreTheIdentityWhereThereIsNoSource) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(turnBetween(Vector3(nan, 0, 0), Vector3(0, 0, 1)), Matrix::Identity());
  EXPECT_TRUE(turnBetween(Vector3(0, 0, 1), Vector3(0, 0, 0)).hasNaN());
  EXPECT_TRUE(turnBetween(Vector3(0, 0, 0), Vector3(0, 0, 1)).hasNaN());
}

TEST(StrandTurns, ConvertQuaternionsOfAnyLength) {
  Random random(2);
  Quaternions q(100, 4);
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    q.row(row) << random.uniform(-1, 1), random.vector(2).transpose();
  }
  const Rotations found = rotationsOf(q);
  for (Eigen::Index row = 0; row < q.rows(); ++row) {
    const Eigen::Quaterniond expected =
        Eigen::Quaterniond(q(row, 0), q(row, 1), q(row, 2), q(row, 3)).normalized();
    const Vector3 probe = random.vector(1);
    EXPECT_LE((matrixOf(found, row) * probe - expected * probe).norm(), 1e-14);
  }
  EXPECT_TRUE(rotationsOf(Quaternions::Zero(1, 4)).hasNaN());
  // The turn by 120 degrees about (1, 1, 1), which takes each axis to the next
  Matrix cyclic;
  cyclic << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  for (const double size : {1e308, 1.0, 1e-308, 5e-324}) {
    const Matrix turn = matrixOf(rotationsOf(Quaternions::Constant(1, 4, size)), 0);
    EXPECT_LE((turn - cyclic).cwiseAbs().maxCoeff(), 1e-15) << size;
  }
}

TEST(StrandTurns, MoveEachStrandWithItsRoot) {
  Random random(3);
  const std::vector<std::int64_t> offsets = {0, 3, 3, 7};
  Points points(7, 3), from(3, 3), to(3, 3), normals(3, 3), others(3, 3);
  for (Points* rows : {&points, &from, &to, &normals, &others}) {
    for (Eigen::Index row = 0; row < rows->rows(); ++row) {
      rows->row(row) = random.vector(2);
    }
  }
  const Rotations turns = shortestTurns(normals, others);
  const Points moved = movedStrands(points, offsets, from, to, turns);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Index strand = i < 3 ? 0 : 2;
    const Vector3 expected =
        to.row(strand).transpose() +
        matrixOf(turns, strand) * (points.row(i) - from.row(strand)).transpose();
    EXPECT_LE((moved.row(i).transpose() - expected).norm(), 1e-14);
  }
  EXPECT_EQ(movedStrands(from, {}, from, to, turns), to);
}

TEST(StrandTurns, RefuseOtherNumbersOfRows) {
  const Points three = Points::Ones(3, 3), two = Points::Ones(2, 3);
  const Rotations turns = Rotations::Zero(3, 9);
  EXPECT_THROW(shortestTurns(three, two), std::invalid_argument);
  EXPECT_THROW(movedStrands(two, {}, three, three, turns), std::invalid_argument);
  EXPECT_THROW(movedStrands(three, {}, two, three, turns), std::invalid_argument);
  EXPECT_THROW(movedStrands(three, {}, three, two, turns), std::invalid_argument);
  EXPECT_THROW(movedStrands(three, {0, 3}, three, three, turns), std::invalid_argument);
  EXPECT_THROW(movedStrands(three, {0, 1, 2, 4}, three, three, turns), std::invalid_argument);
  EXPECT_THROW(movedStrands(three, {0, 2, 1, 3}, three, three, turns), std::invalid_argument);
}

}  // namespace
}  // namespace limitsurf::test
