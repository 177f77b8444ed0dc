// SPDX-License-Identifier: Apache-2.0
//
// Boxes around data on squares of the faces hold what is evaluated there, and are not much wider.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "limitsurf/surface/surface_data.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/random.h"
#include "support/throws.h"
#include "support/truth/channels.h"
#include "support/truth/scatter_witness.h"

namespace limitsurf::test {
namespace {

/// Places in each square of each face: its corners, its middle and random ones, square by square.
constexpr int kPlaces = 12;

std::vector<Location> placesOf(const SurfaceData& data, int side, Random& random) {
  std::vector<Location> at;
  for (int face = 0; face < data.faceCount(); ++face) {
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        for (int i = 0; i < kPlaces; ++i) {
          const double s = i < 4 ? i & 1 : random.uniform(), t = i < 4 ? i >> 1 : random.uniform();
          at.push_back({face, std::min((column + s) / side, 1.), std::min((row + t) / side, 1.)});
        }
      }
    }
  }
  return at;
}

/// The largest part of a box's width that no place comes near to, if all values lie in their boxes;
/// infinity if one does not. Widths are those of the widest column of the box.
double slack(const SurfaceData& data, int side, Random& random) {
  const DataBounds boxes = data.bounds(side);
  const DataRows value = data.evaluate(placesOf(data, side, random)).value;
  double most = 0;
  for (Eigen::Index box = 0; box < boxes.low.rows(); ++box) {
    const auto values = value.middleRows(box * kPlaces, kPlaces).array();
    const Eigen::ArrayXd low = values.colwise().minCoeff().transpose(),
                         high = values.colwise().maxCoeff().transpose();
    const Eigen::ArrayXd under = low - boxes.low.row(box).transpose().array(),
                         over = boxes.high.row(box).transpose().array() - high;
    if (!(under.minCoeff() >= 0 && over.minCoeff() >= 0)) {
      return INFINITY;
    }
    const double width = (high - low).maxCoeff();
    most = std::max(most, std::max(under.maxCoeff(), over.maxCoeff()) / width);
  }
  return most;
}

TEST(DataBounds, HoldAllValuesOfSmoothData) {
  Random random(1);
  int index = 0;
  for (const auto& [name, cage] : NamedCages{{"all kinds", scatteredCage()},
                                             {"mixture", mixture(4)},
                                             {"pole", pole(40)},
                                             {"valence 2", valenceTwo()},
                                             {"cross", cross()}}) {
    SCOPED_TRACE(name);
    // scatteredCage() has no refused faces but holes, on which nothing can be evaluated.
    Cage whole = cage;
    whole.options.holes.clear();
    const LimitSurface surface = limitSurface(whole);
    for (const int columns : {1, 3, 5}) {
      const SurfaceData data =
          surface.vertexData(randomRows(static_cast<int>(whole.vertexCount()), columns, ++index));
      for (const int side : {1, 3, 4}) {
        EXPECT_LT(slack(data, side, random), INFINITY) << columns << " columns, side " << side;
      }
    }
  }
}

TEST(DataBounds, HoldAllValuesOfChannelsWithSeams) {
  Random random(2);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Cage cage = mixture(seed);
    const Channel channel = randomChannel(cage, random);
    const DataRows values = randomRows(channel.value_count, 2, seed);
    for (const Interpolation rule : {Interpolation::none, Interpolation::corners_only,
                                     Interpolation::boundaries, Interpolation::all}) {
      const SurfaceData data = limitSurface(cage).faceVarying(values, channel.indices, rule);
      for (const int side : {1, 4}) {
        EXPECT_LT(slack(data, side, random), INFINITY) << "seed " << seed << ", side " << side;
      }
    }
  }
}

/// The truth is the definition: the extremes of a bilinear function lie at corners.
TEST(DataBounds, AreExactForVaryingData) {
  const Cage cage = mixture(7);
  const SurfaceData data = limitSurface(cage).varying(randomRows(cage.vertexCount(), 3, 9));
  const double padding = kBoundsPadding * 2 * std::sqrt(3.);  // values lie in [-1, 1]
  for (const int side : {1, 4}) {
    const DataBounds boxes = data.bounds(side);
    Eigen::Index box = 0;
    for (int face = 0; face < data.faceCount(); ++face) {
      for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column, ++box) {
          std::vector<Location> at;
          for (int corner = 0; corner < 4; ++corner) {
            at.push_back(
                {face, double(column + (corner & 1)) / side, double(row + (corner >> 1)) / side});
          }
          const DataRows value = data.evaluate(at).value;
          for (Eigen::Index i = 0; i < 3; ++i) {
            EXPECT_NEAR(boxes.low(box, i), value.col(i).minCoeff(), 1.1 * padding);
            EXPECT_NEAR(boxes.high(box, i), value.col(i).maxCoeff(), 1.1 * padding);
          }
        }
      }
    }
  }
}

/// (Corners of boundaries are left out: the surface turns around there within any square.)
TEST(DataBounds, AreTight) {
  Random random(3);
  const Cage cage = perturbed(torus(8, 6), 0.1, 5);
  const SurfaceData data = limitSurface(cage).vertexData(DataRows(cage.positions));
  EXPECT_LT(slack(data, 1, random), 0.1);
  EXPECT_LT(slack(data, 16, random), 0.02);
}

/// Where the padding in units of the range is less than the rounding of the values themselves, and
/// where the squares of the values underflow.
TEST(DataBounds, HoldFarFromZeroAndForTinyValues) {
  Random random(8);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Cage cage = mixture(seed);
    DataRows values = randomRows(cage.vertexCount(), 3, seed);
    values.col(0) = values.col(0).array() * 1e-3 + 1;
    values.col(1) = values.col(1).array() * 1e-12 - 7;
    const LimitSurface surface = limitSurface(cage);
    EXPECT_LT(slack(surface.varying(values), 2, random), INFINITY) << "seed " << seed;
    EXPECT_LT(slack(surface.vertexData(values), 2, random), INFINITY) << "seed " << seed;
    const SurfaceData tiny = surface.vertexData(randomRows(cage.vertexCount(), 3, seed) * 1e-170);
    EXPECT_LT(slack(tiny, 4, random), INFINITY) << "seed " << seed;
  }
}

/// A weight that is 0 around a square is 0 there, and its bounds say so.
TEST(DataBounds, AreExactlyZeroWhereDataAre) {
  Random random(9);
  int zeros = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Cage cage = mixture(seed);
    DataRows values = randomRows(cage.vertexCount(), 1, seed);
    for (double& value : values.reshaped()) value = random.below(8) == 0 ? value : 0;
    const LimitSurface surface = limitSurface(cage);
    for (const SurfaceData& data : {surface.varying(values), surface.vertexData(values)}) {
      const DataBounds boxes = data.bounds(2);
      const DataRows value = data.evaluate(placesOf(data, 2, random)).value;
      for (Eigen::Index box = 0; box < boxes.low.rows(); ++box) {
        if (boxes.low(box, 0) == 0 && boxes.high(box, 0) == 0) {
          ++zeros;
          EXPECT_EQ(value.middleRows(box * kPlaces, kPlaces).cwiseAbs().maxCoeff(), 0);
        }
      }
    }
  }
  EXPECT_GT(zeros, 100);
}

TEST(DataBounds, AreNaNWithoutASurface) {
  Cage cage = grid(2, 2);
  cage.options.holes = {1};
  const DataBounds boxes = limitSurface(cage).vertexData(DataRows(cage.positions)).bounds(2);
  ASSERT_EQ(boxes.low.rows(), 16);
  for (Eigen::Index box = 0; box < 16; ++box) {
    EXPECT_EQ(boxes.low.row(box).hasNaN(), box / 4 == 1);
    EXPECT_EQ(boxes.high.row(box).hasNaN(), box / 4 == 1);
  }
}

TEST(DataBounds, RefuseSidesOutOfRange) {
  const Cage cage = grid(1, 1);
  const SurfaceData data = limitSurface(cage).vertexData(DataRows(cage.positions));
  for (const int side : {0, -3, 1025}) {
    expectThrow<std::invalid_argument>([&] { data.bounds(side); },
                                       {"side is " + std::to_string(side), "1 to 1024"});
  }
}

}  // namespace
}  // namespace limitsurf::test
