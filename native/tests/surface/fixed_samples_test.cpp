// SPDX-License-Identifier: Apache-2.0
//
// Fixed samples give what the surface gives in every pose. (compareWithSubdivision() holds them to
// subdivision at vertices of all valences.)
#include "limitsurf/surface/fixed/fixed_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "limitsurf/error.h"
#include "limitsurf/interruption_point.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/truth/accuracy.h"
#include "support/truth/golden.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

constexpr Derivatives kFixedOrders[] = {Derivatives::none, Derivatives::first};

std::vector<Location> places(const Cage& cage) {
  Random random(3);
  return everywhere(cage, {1, 4, 9, 30}, 3, random);
}

/// Meshes whose samples have all kinds of weights, and some that have too many.
std::vector<Cage> someCages() {
  std::vector<Cage> cages = {perturbed(grid(6, 6), 0.2, 1),
                             cross(),
                             prism(5, true),
                             fan(7, true, 1),
                             fan(6, false, 2),
                             ngon(6, 3),
                             mixture(4),
                             fan(40, true, 5),
                             fan(45, false, 5),
                             ngon(70, 6),
                             ngon(150, 7),
                             pole(80)};
  Cage sharp = mixture(8);
  Random random(9);
  sharpenAtRandom(sharp, random, 3, 6, {0.5, 2.3, 4, 10});
  cages.push_back(sharp);
  return cages;
}

bool sameBits(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

/// Holds both to the sum of the bounds; `rounding` is that of the positions' own coordinates.
void expectSame(const Evaluation& got, const Evaluation& expected, double size,
                const std::vector<Location>& at, double rounding = 0) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_LE((got.position.row(row) - expected.position.row(row)).norm(),
              2 * (kPositionError * size + rounding))
        << describe(at[i]);
    for (const auto& [a, b] : {std::pair(&got.du, &expected.du), {&got.dv, &expected.dv}}) {
      ASSERT_EQ(a->rows(), b->rows());
      if (a->rows() == 0) continue;
      const Vector3 value = a->row(row), truth = b->row(row);
      if (truth.hasNaN()) {
        EXPECT_TRUE(value.array().isNaN().all()) << describe(at[i]);
      } else {
        EXPECT_LE((value - truth).norm(), 2 * kFirstDerivativeError * std::max(size, truth.norm()))
            << describe(at[i]);
      }
    }
  }
}

class GoldenFixedSamples : public testing::TestWithParam<std::string> {};

TEST_P(GoldenFixedSamples, ReachTheGoldenValues) {
  const Golden golden = readGolden(GetParam());
  const LimitSurface surface = limitSurface(golden.cage);
  Accuracy accuracy(golden.name, diagonal(golden.cage.positions));
  for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
    accuracy.addScale(golden.at[i], truthOf(golden, i));
  }
  for (Derivatives order : kFixedOrders) {
    const Evaluation got = FixedSamples(surface, golden.at, order).evaluate(golden.cage.positions);
    for (int i = 0; i < static_cast<int>(golden.at.size()); ++i) {
      Truth truth = upTo(order, truthOf(golden, i));
      truth.values[kNormal].setConstant(NAN);
      accuracy.check(golden.at[i], rowOf(got, i), truth);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenFixedSamples, testing::ValuesIn(goldenNames()),
                         [](const auto& test) { return test.param; });

TEST(FixedSamples, FollowEveryPose) {
  for (const Cage& cage : someCages()) {
    LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    for (Derivatives order : kFixedOrders) {
      const FixedSamples samples(surface, at, order);
      for (std::uint64_t pose : {0, 1, 2}) {
        const Cage moved = perturbed(cage, pose == 0 ? 0 : 0.5, pose);
        surface.setPositions(moved.positions);
        expectSame(samples.evaluate(moved.positions), surface.evaluate(at, order),
                   diagonal(moved.positions), at);
      }
    }
  }
}

TEST(FixedSamples, KeepTheirDerivativesFarFromTheOrigin) {
  for (Cage cage : {mixture(4), ngon(6, 3), perturbed(grid(6, 6), 0.2, 1)}) {
    // Coordinates are multiples of 2^-20, which are still there far away.
    cage.positions = (cage.positions * 0x1p20).array().round() * 0x1p-20;
    const Vector3 shift(0x1p17, -0x1p18, 0x1p18);
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    const FixedSamples samples(surface, at, Derivatives::first);
    Evaluation got = samples.evaluate(placed(cage, 1, shift).positions);
    got.position.rowwise() -= shift.transpose();
    expectSame(got, samples.evaluate(cage.positions), diagonal(cage.positions), at,
               0x1p18 * 0x1p-52);
  }
}

TEST(FixedSamples, OnRegularQuadsHaveTheBitsOfTheEvaluation) {
  const Cage cage = perturbed(torus(7, 5), 0.2, 2);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = places(cage);
  const Evaluation got = FixedSamples(surface, at, Derivatives::first).evaluate(cage.positions);
  const Evaluation expected = surface.evaluate(at, Derivatives::first);
  EXPECT_TRUE(sameBits(got.position, expected.position));
  EXPECT_TRUE(sameBits(got.du, expected.du));
  EXPECT_TRUE(sameBits(got.dv, expected.dv));
}

TEST(FixedSamples, DependNeitherOnThreadsNorOnOtherSamples) {
  for (const Cage& cage : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    std::vector<Location> half;
    for (std::size_t i = at.size(); i-- > 0;) {
      if (i % 2 == 0) half.push_back(at[i]);
    }
    for (Derivatives order : kFixedOrders) {
      const Evaluation all = FixedSamples(surface, at, order, 1).evaluate(cage.positions, 1);
      const Evaluation threaded = FixedSamples(surface, at, order, 2).evaluate(cage.positions, 2);
      const Evaluation some = FixedSamples(surface, half, order).evaluate(cage.positions);
      for (const auto member : {&Evaluation::position, &Evaluation::du, &Evaluation::dv}) {
        EXPECT_TRUE(sameBits(all.*member, threaded.*member));
        if ((all.*member).rows() == 0) continue;
        Points expected(static_cast<Eigen::Index>(half.size()), 3);
        Eigen::Index next = 0;
        for (auto i = static_cast<Eigen::Index>(at.size()); i-- > 0;) {
          if (i % 2 == 0) expected.row(next++) = (all.*member).row(i);
        }
        EXPECT_TRUE(sameBits(some.*member, expected));
      }
    }
  }
}

TEST(FixedSamples, DependOnNoThreadInManyTasks) {
  // More vertices than one task copies, and more samples of each kind than one task evaluates.
  Cage cage = perturbed(torus(140, 130), 0.01, 2);
  for (std::size_t face = 0; face < 40; ++face) {
    const std::vector<int> quad = cage.faces[face];
    sharpenEdge(cage, quad[0], quad[1], 2.5);
  }
  const LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  Random random(4);
  for (int face = 0; face < surface.faceCount(); ++face) {
    at += anywhere(face, face < 200 ? 100 : 2, random);
  }
  const FixedSamples samples(surface, at, Derivatives::first);
  const Evaluation one = samples.evaluate(cage.positions, 1);
  const Evaluation two = samples.evaluate(cage.positions, 2);
  EXPECT_TRUE(sameBits(one.position, two.position));
  EXPECT_TRUE(sameBits(one.du, two.du));
  EXPECT_TRUE(sameBits(one.dv, two.dv));
  expectSame(one, surface.evaluate(at, Derivatives::first), diagonal(cage.positions), at);
}

TEST(FixedSamples, GoOnAfterAnInterruption) {
  struct Interrupted {};
  const Cage cage = fan(40, true, 5);  // some of its samples are posed, others have weights
  const LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  for (int i = 0; i < 20; ++i) at += places(cage);
  const FixedSamples samples(surface, at, Derivatives::first);
  const Evaluation expected = samples.evaluate(cage.positions);
  for (const int passes : {0, 1, 3}) {
    int left = passes;
    {
      const InterruptionPoint point([&] {
        if (left-- == 0) throw Interrupted();
      });
      EXPECT_THROW(samples.evaluate(2 * cage.positions, 1), Interrupted) << passes;
    }
    const Evaluation got = samples.evaluate(cage.positions);
    EXPECT_TRUE(sameBits(got.position, expected.position));
    EXPECT_TRUE(sameBits(got.du, expected.du));
  }
}

TEST(FixedSamples, HaveTheSameBitsWithAllInstructionSets) {
  const InstructionSet before = instructionSet();
  for (const Cage& cage : someCages()) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    for (Derivatives order : kFixedOrders) {
      const FixedSamples samples(surface, at, order);
      useInstructionSet(InstructionSet::baseline);
      const Evaluation expected = samples.evaluate(cage.positions);
      for (InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
        if (!isAvailable(set)) continue;
        useInstructionSet(set);
        const Evaluation got = samples.evaluate(cage.positions);
        EXPECT_TRUE(sameBits(got.position, expected.position));
        EXPECT_TRUE(sameBits(got.du, expected.du));
        EXPECT_TRUE(sameBits(got.dv, expected.dv));
      }
    }
  }
  useInstructionSet(before);
}

TEST(FixedSamples, RoundToFloatWhatTheyGiveInDouble) {
  for (const Cage& cage : {mixture(4), fan(40, true, 5)}) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = places(cage);
    const FixedSamples samples(surface, at, Derivatives::first);
    const Evaluation exact = samples.evaluate(cage.positions);
    FloatPoints position(static_cast<Eigen::Index>(at.size()), 3), du = position, dv = position;
    samples.evaluate<float>(
        cage.positions,
        {{position.data(), at.size()}, {du.data(), at.size()}, {dv.data(), at.size()}});
    EXPECT_EQ(position, exact.position.cast<float>());
    for (Eigen::Index row = 0; row < du.rows(); ++row) {
      for (int c = 0; c < 3; ++c) {
        const auto same = [](float a, double b) {
          return a == static_cast<float>(b) || (std::isnan(a) && std::isnan(b));
        };
        EXPECT_TRUE(same(du(row, c), exact.du(row, c)) && same(dv(row, c), exact.dv(row, c)));
      }
    }
  }
}

TEST(FixedSamples, OutliveTheirSurface) {
  const Cage cage = fan(40, true, 5);  // some of its samples are posed, others have weights
  const std::vector<Location> at = places(cage);
  auto surface = std::make_unique<LimitSurface>(controlMesh(cage));
  const Evaluation expected = surface->evaluate(at, Derivatives::first);
  const FixedSamples samples(*surface, at, Derivatives::first);
  surface.reset();
  expectSame(samples.evaluate(cage.positions), expected, diagonal(cage.positions), at);
}

TEST(FixedSamples, TakeLittleMemory) {
  const Cage cage = perturbed(torus(20, 20), 0.2, 2);
  const LimitSurface surface = limitSurface(cage);
  std::vector<Location> at;
  Random random(1);
  for (int face = 0; face < surface.faceCount(); ++face) at += anywhere(face, 10, random);
  const FixedSamples samples(surface, at, Derivatives::first);
  EXPECT_EQ(samples.size(), at.size());
  EXPECT_LE(samples.bytes(), 25 * at.size());
}

TEST(FixedSamples, RefuseWhatTheyCannotUse) {
  const Cage cage = mixture(4);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<Location> at = places(cage);
  EXPECT_THROW(FixedSamples(surface, at, Derivatives::second), std::invalid_argument);
  EXPECT_THROW(FixedSamples(surface, std::vector<Location>{{0, 2, 0}}), LocationError);
  const FixedSamples samples(surface, at, Derivatives::first);
  EXPECT_THROW(samples.evaluate(cage.positions.topRows(3)), MeshError);
  Points broken = cage.positions;
  broken(1, 2) = NAN;
  EXPECT_THROW(samples.evaluate(broken), MeshError);
  Points few(1, 3), enough(static_cast<Eigen::Index>(at.size()), 3);
  enough.setConstant(7);
  EXPECT_THROW(samples.evaluate<double>(
                   cage.positions,
                   {{enough.data(), at.size()}, {enough.data(), at.size()}, {few.data(), 1}}),
               std::invalid_argument);
  EXPECT_TRUE((enough.array() == 7).all());
}

TEST(FixedSamples, MayBeNone) {
  const Cage cage = mixture(4);
  const FixedSamples samples(limitSurface(cage), std::vector<Location>{}, Derivatives::first);
  EXPECT_EQ(samples.size(), 0u);
  EXPECT_EQ(samples.evaluate(cage.positions).position.rows(), 0);
}

}  // namespace
}  // namespace limitsurf::test
