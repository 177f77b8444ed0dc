// SPDX-License-Identifier: Apache-2.0
//
// Frames of several rows at once are those of frame() one by one, to the bit, with all vector
// instruction sets that this machine has.
#include "limitsurf/surface/batch/frame_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/differential.h"
#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

constexpr int kRows = 3000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Frame = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Vectors of lengths from 2^-700 to 2^700, some of them zero or not finite.
Points vectors(Random& random) {
  Points result(kRows, 3);
  for (int row = 0; row < kRows; ++row) {
    const double size = row % 3 == 0 ? std::ldexp(1, random.below(1400) - 700) : 1;
    for (int axis = 0; axis < 3; ++axis) {
      result(row, axis) = size * (2 * random.uniform() - 1);
    }
    if (row % 50 == 0) result.row(row).setZero();
    if (row % 53 == 0) result(row, row % 2) = kNaN;
    if (row % 59 == 0) result(row, 2) = std::numeric_limits<double>::infinity();
  }
  return result;
}

TEST(FrameKernels, GiveTheBitsOfOneAtATime) {
  Random random(8);
  const InstructionSet before = instructionSet();
  const Points du = vectors(random), normal = vectors(random);
  for (InstructionSet set :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!isAvailable(set)) continue;
    useInstructionSet(set);
    int plain_rows = 0;
    for (int begin = 0; begin < kRows;) {
      const int count = std::min(1 + random.below(FrameKernels::kMostRows), kRows - begin);
      double found[9 * FrameKernels::kMostRows];
      const unsigned plain =
          FrameKernels::get().frames(du.row(begin).data(), normal.row(begin).data(), found, count);
      EXPECT_EQ(plain >> count, 0u);
      for (int i = 0; i < count; ++i) {
        if ((plain >> i & 1) == 0) continue;
        const Frame expected = frame(du.row(begin + i), Vector3::Zero(), normal.row(begin + i));
        EXPECT_EQ(std::memcmp(found + 9 * i, expected.data(), sizeof expected), 0)
            << "row " << begin + i;
        ++plain_rows;
      }
      begin += count;
    }
    EXPECT_GT(plain_rows, kRows / 2);
  }
  useInstructionSet(before);
}

TEST(FrameKernels, LeaveWhatIsNotPlainToOthers) {
  const double tiny = 1e-200, du[12] = {tiny, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 3},
               normal[12] = {0, 0, 1, 0, 0, 0, 0, kNaN, 1, 0, 0, 1};
  double found[9 * 4];
  EXPECT_EQ(FrameKernels::get().frames(du, normal, found, 4), 0u);
}

TEST(FrameKernels, AreUsedWithTheSameBits) {
  const InstructionSet before = instructionSet();
  for (const Cage& cage : {mixture(21), fan(11, true, 1), cross(), perturbed(grid(8, 8), 0.2, 3)}) {
    const LimitSurface surface = limitSurface(cage);
    Random random(9);
    std::vector<Location> at;
    for (int face = 0; face < surface.faceCount(); ++face) {
      at += anywhere(face, 1 + random.below(20), random);
      at += shells(face, random.below(4), {3, 40});
      at.push_back(cornerLocation(face, random.below(4)));
    }
    useInstructionSet(InstructionSet::baseline);
    Points position(at.size(), 3), others(at.size(), 3);
    Rotations expected(at.size(), 9), found(at.size(), 9);
    surface.frames(at, {{position.data(), at.size()}, {expected.data(), at.size()}}, 1);
    const Points alone = surface.evaluate(at).position;
    EXPECT_EQ(std::memcmp(position.data(), alone.data(), sizeof(double) * alone.size()), 0);
    for (InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
      if (!isAvailable(set)) continue;
      useInstructionSet(set);
      surface.frames(at, {{others.data(), at.size()}, {found.data(), at.size()}}, 2);
      EXPECT_EQ(std::memcmp(found.data(), expected.data(), sizeof(double) * found.size()), 0);
      EXPECT_EQ(std::memcmp(others.data(), position.data(), sizeof(double) * others.size()), 0);
    }
    useInstructionSet(before);
  }
}

TEST(FrameKernels, ArraysOfOtherSizesAreRefused) {
  const LimitSurface surface = limitSurface(cube());
  const std::vector<Location> at = {{0, 0.5, 0.5}, {1, 0.5, 0.5}};
  Rotations frames(2, 9);
  Points position(1, 3);
  EXPECT_THROW(surface.frames(at, {{}, {frames.data(), 1}}), std::invalid_argument);
  EXPECT_THROW(surface.frames(at, {{position.data(), 1}, {frames.data(), 2}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace limitsurf::test
