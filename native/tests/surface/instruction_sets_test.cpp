// SPDX-License-Identifier: Apache-2.0
//
// All vector instruction sets that this machine has give the same bits, and what they give is what
// TileEvaluator gives one location at a time.
#include "limitsurf/surface/batch/instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <tuple>

#include "limitsurf/surface/pose/pose.h"
#include "limitsurf/surface/tile_evaluator.h"
#include "limitsurf/surface/tiled_surface.h"
#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// Uses another instruction set for its lifetime.
class Using {
 public:
  explicit Using(InstructionSet set) : before_(instructionSet()) { useInstructionSet(set); }
  ~Using() { useInstructionSet(before_); }
  Using(const Using&) = delete;
  Using& operator=(const Using&) = delete;

 private:
  InstructionSet before_;
};

std::vector<InstructionSet> availableSets() {
  std::vector<InstructionSet> sets;
  for (InstructionSet set :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (isAvailable(set)) sets.push_back(set);
  }
  return sets;
}

/// Runs of 1 to 40 locations on each face in turn, some of them at and near vertices, and then
/// single ones.
std::vector<Location> runs(const Cage& cage) {
  Random random(5);
  std::vector<Location> at;
  const int faces = static_cast<int>(ptexFaces(cage).size());
  for (int round = 0; round < 4; ++round) {
    for (int face = 0; face < faces; ++face) {
      at += anywhere(face, 1 + random.below(40), random);
      at += shells(face, random.below(4), {1 + random.below(6), 1 + random.below(45)});
      at.push_back(cornerLocation(face, random.below(4)));
    }
  }
  for (int round = 0; round < 4; ++round) {
    for (int face = 0; face < faces; ++face) at += anywhere(face, 1, random);
  }
  return at;
}

std::vector<const Points*> members(const Evaluation& e) {
  return {&e.position, &e.du, &e.dv, &e.duu, &e.duv, &e.dvv, &e.normal};
}

void expectSameBits(const Evaluation& a, const Evaluation& b, const std::vector<Location>& at) {
  for (std::size_t i = 0; i < 7; ++i) {
    const Points &x = *members(a)[i], &y = *members(b)[i];
    ASSERT_EQ(x.rows(), y.rows());
    for (Eigen::Index row = 0; row < x.rows(); ++row) {
      ASSERT_EQ(std::memcmp(x.data() + 3 * row, y.data() + 3 * row, 3 * sizeof(double)), 0)
          << "member " << i << ", row " << row << ", " << describe(at[row]) << ": " << x.row(row)
          << " and " << y.row(row);
    }
  }
}

class InstructionSets : public testing::TestWithParam<int> {
 protected:
  Cage cage() const {
    switch (GetParam()) {
      case 0:
        return mixture(21);
      case 1:
        return fan(11, true, 1);
      case 2:
        return perturbed(grid(8, 8), 0.2, 3);
      default:
        return cross();
    }
  }
};

TEST_P(InstructionSets, GiveTheSameBits) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = runs(cage());
  for (Derivatives derivatives : {Derivatives::none, Derivatives::first, Derivatives::second}) {
    const Using baseline(InstructionSet::baseline);
    const Evaluation expected = surface.evaluate(at, derivatives, true, 1);
    for (InstructionSet set : availableSets()) {
      const Using other(set);
      expectSameBits(expected, surface.evaluate(at, derivatives, true, 1), at);
    }
  }
}

TEST_P(InstructionSets, PoseTheSameBits) {
  LimitSurface surface = limitSurface(cage());
  const Points positions = surface.positions();
  const std::vector<Location> at = runs(cage());
  const auto posedWith = [&](InstructionSet set) {
    {
      const Using posing(set);
      surface.setPositions(positions);
    }
    return surface.evaluate(at, Derivatives::second, true, 1);
  };
  const Evaluation expected = posedWith(InstructionSet::baseline);
  for (InstructionSet set : availableSets()) {
    expectSameBits(expected, posedWith(set), at);
  }
}

TEST_P(InstructionSets, GiveWhatOneAtATimeGives) {
  const Cage input = cage();
  const LimitSurface surface = limitSurface(input);
  const TiledSurface tiles(surface.mesh());
  Pose pose(tiles.table);
  pose.set(surface.positions(), 1);
  TileEvaluator evaluator(tiles.table, pose);
  const std::vector<Location> at = runs(input);
  const Evaluation e = surface.evaluate(at, Derivatives::second, false, 1);
  const double size = diagonal(input.positions);
  for (std::size_t row = 0; row < at.size(); ++row) {
    Jet jet;
    evaluator.evaluate<2>(evaluator.locate(at[row]), jet);
    const auto i = static_cast<Eigen::Index>(row);
    const auto near = [&](const Points& of, const Padded& value, double error) {
      const Vector3 a = of.row(i), b = value.head<3>();
      return a.hasNaN() ? b.hasNaN() : (a - b).norm() <= error * (size + b.norm());
    };
    ASSERT_TRUE(near(e.position, jet.anchor + jet.patch.value, kPositionError) &&
                near(e.du, jet.patch.du, kFirstDerivativeError) &&
                near(e.dv, jet.patch.dv, kFirstDerivativeError) &&
                near(e.duu, jet.second(jet.patch.duu), kSecondDerivativeError) &&
                near(e.duv, jet.second(jet.patch.duv), kSecondDerivativeError) &&
                near(e.dvv, jet.second(jet.patch.dvv), kSecondDerivativeError))
        << describe(at[row]);
  }
}

TEST_P(InstructionSets, RoundToFloatWhatTheyGiveInDouble) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = runs(cage());
  const auto rows = static_cast<Eigen::Index>(at.size());
  using Floats = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const Evaluation expected = surface.evaluate(at, Derivatives::second, true, 1);
  for (InstructionSet set : availableSets()) {
    const Using other(set);
    std::vector<Floats> floats(7, Floats(rows, 3));
    const auto in = [&](int i) {
      return EvaluationArrays<float>::Rows{floats[i].data(), at.size()};
    };
    surface.evaluate<float>(at, Derivatives::second,
                            {in(0), in(1), in(2), in(3), in(4), in(5), in(6)}, 1);
    for (std::size_t i = 0; i < 7; ++i) {
      const Floats rounded = members(expected)[i]->cast<float>();
      for (Eigen::Index row = 0; row < rows; ++row) {
        ASSERT_TRUE(floats[i].row(row) == rounded.row(row) ||
                    (floats[i].row(row).hasNaN() && rounded.row(row).hasNaN()))
            << "member " << i << ", " << describe(at[row]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cages, InstructionSets, testing::Values(0, 1, 2, 3));

TEST(InstructionSets, TheWidestIsInUse) {
  EXPECT_TRUE(isAvailable(InstructionSet::baseline));
  EXPECT_EQ(instructionSet(), availableSets().back());
}

}  // namespace
}  // namespace limitsurf::test
