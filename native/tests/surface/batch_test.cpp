// SPDX-License-Identifier: Apache-2.0
//
// The result for a location has the same bits for any number of threads, and whatever else is in
// the batch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

#include "limitsurf/mesh/control_mesh.h"
#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

bool sameBits(const Points& a, const Points& b) {
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

bool sameBits(const Evaluation& a, const Evaluation& b) {
  return sameBits(a.position, b.position) && sameBits(a.du, b.du) && sameBits(a.dv, b.dv) &&
         sameBits(a.duu, b.duu) && sameBits(a.duv, b.duv) && sameBits(a.dvv, b.dvv) &&
         sameBits(a.normal, b.normal);
}

/// Locations of all kinds in random order, several times as many as a task has.
std::vector<Location> manyLocations(const Cage& cage, int count) {
  Random random(11);
  const int faces = static_cast<int>(ptexFaces(cage).size());
  std::vector<Location> at;
  while (static_cast<int>(at.size()) < count) {
    const int face = random.below(faces);
    at += anywhere(face, 3, random);
    at += shells(face, random.below(4), {random.below(45)});
    at.push_back(cornerLocation(face, random.below(4)));
  }
  return at;
}

class Batch : public testing::TestWithParam<int> {
 protected:
  Cage cage() const {
    switch (GetParam()) {
      case 0:
        return mixture(21);
      case 1:
        return fan(11, true, 1);
      default:
        return cross();
    }
  }
};

TEST_P(Batch, ThreadsDoNotChangeABit) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = manyLocations(cage(), 20000);
  const Evaluation one = surface.evaluate(at, Derivatives::second, true, 1);
  for (int threads : {0, 2, 3, 7}) {
    EXPECT_TRUE(sameBits(one, surface.evaluate(at, Derivatives::second, true, threads)));
  }
  const auto frames = surface.frames(at, 1);
  EXPECT_EQ(
      std::memcmp(frames.data(), surface.frames(at, 0).data(), frames.size() * sizeof(double)), 0);
}

TEST_P(Batch, OtherLocationsDoNotChangeABit) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = manyLocations(cage(), 3000);
  const Evaluation whole = surface.evaluate(at, Derivatives::second, true);
  for (int size : {1, 2, 3, 7, 64, 1000}) {
    for (int begin = 0; begin < static_cast<int>(at.size()); begin += size) {
      const int count = std::min<int>(size, static_cast<int>(at.size()) - begin);
      const Evaluation part =
          surface.evaluate(Span<Location>(at).subspan(begin, count), Derivatives::second, true);
      const Points position = whole.position.middleRows(begin, count);
      const Points dvv = whole.dvv.middleRows(begin, count);
      const Points normal = whole.normal.middleRows(begin, count);
      ASSERT_TRUE(sameBits(part.position, position) && sameBits(part.dvv, dvv) &&
                  sameBits(part.normal, normal))
          << "rows " << begin << " to " << begin + count;
    }
  }
}

TEST_P(Batch, OrderDoesNotChangeABit) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = manyLocations(cage(), 5000);
  std::vector<int> order(at.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tie(at[a].face, at[a].v, at[a].u) < std::tie(at[b].face, at[b].v, at[b].u);
  });
  std::vector<Location> sorted;
  for (int i : order) sorted.push_back(at[i]);
  const Evaluation mixed = surface.evaluate(at, Derivatives::second, true);
  const Evaluation ordered = surface.evaluate(sorted, Derivatives::second, true);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (const auto& [a, b] :
         {std::pair(&mixed.position, &ordered.position), std::pair(&mixed.du, &ordered.du),
          std::pair(&mixed.duv, &ordered.duv)}) {
      ASSERT_EQ(std::memcmp(a->data() + 3 * order[i], b->data() + 3 * i, 3 * sizeof(double)), 0)
          << describe(sorted[i]);
    }
  }
}

TEST_P(Batch, GivesWhatWasAskedFor) {
  const LimitSurface surface = limitSurface(cage());
  const std::vector<Location> at = manyLocations(cage(), 2000);
  const Evaluation all = surface.evaluate(at, Derivatives::second, true);
  const Evaluation first = surface.evaluate(at, Derivatives::first);
  const Evaluation none = surface.evaluate(at);
  EXPECT_EQ(all.dvv.rows(), static_cast<int>(at.size()));
  EXPECT_EQ(all.normal.rows(), static_cast<int>(at.size()));
  EXPECT_EQ(none.du.rows(), 0);
  EXPECT_EQ(first.duu.rows(), 0);
  EXPECT_EQ(first.normal.rows(), 0);
  // The bits may differ, because each order of derivatives may be computed in its own way.
  const double allowed = kPositionError * diagonal(cage().positions);
  EXPECT_LE((all.position - none.position).cwiseAbs().maxCoeff(), allowed);
  EXPECT_LE((all.position - first.position).cwiseAbs().maxCoeff(), allowed);
}

TEST_P(Batch, SettingPositionsEqualsANewSurface) {
  LimitSurface surface = limitSurface(cage());
  const Cage moved = perturbed(cage(), 0.3, 5);
  const std::vector<Location> at = manyLocations(cage(), 5000);
  for (int threads : {1, 0}) {
    surface.setPositions(cage().positions);
    surface.setPositions(moved.positions, threads);
    EXPECT_TRUE(sameBits(surface.positions(), moved.positions));
    EXPECT_TRUE(sameBits(surface.evaluate(at, Derivatives::second, true),
                         limitSurface(moved).evaluate(at, Derivatives::second, true)));
  }
}

// Rows of a patch are evaluated several at a time, and those that are left over in other ways.
TEST_P(Batch, RunsOfAnyLengthDoNotChangeABit) {
  const LimitSurface surface = limitSurface(cage());
  Random random(3);
  for (int face = 0; face < surface.faceCount(); ++face) {
    for (const double part : {1., 0.5, 0x1p-7}) {  // of the face, so that few patches meet it
      const std::vector<Location> all = anywhere(face, 21, random);
      std::vector<Location> at;
      for (const Location& l : all) at.push_back({face, part * l.u, part * l.v});
      for (const Derivatives order : {Derivatives::none, Derivatives::first, Derivatives::second}) {
        std::vector<Evaluation> alone;
        for (const Location& l : at) {
          alone.push_back(
              surface.evaluate(Span<Location>(&l, 1), order, order > Derivatives::none));
        }
        for (std::size_t count = 1; count <= at.size(); ++count) {
          const Evaluation run = surface.evaluate(Span<Location>(at).subspan(0, count), order,
                                                  order > Derivatives::none);
          for (std::size_t row = 0; row < count; ++row) {
            const auto i = static_cast<Eigen::Index>(row);
            for (const auto member : {&Evaluation::position, &Evaluation::du, &Evaluation::dv,
                                      &Evaluation::duv, &Evaluation::normal}) {
              if ((run.*member).rows() > 0) {
                ASSERT_TRUE(sameBits((run.*member).row(i), alone[row].*member))
                    << describe(at[row]) << ", " << count << " rows";
              }
            }
          }
        }
      }
    }
  }
}

// Many rows of a face are put in order by the parts of the face, again and again.
TEST_P(Batch, ManyRowsOfAFaceDoNotChangeABit) {
  const LimitSurface surface = limitSurface(cage());
  Random random(4);
  for (int face = 0; face < surface.faceCount(); ++face) {
    std::vector<Location> at = anywhere(face, 3000, random);
    for (std::size_t i = 0; i < at.size(); i += 7) at[i].u = i % 2 == 0 ? 0 : 0.5;
    for (std::size_t i = 3; i < at.size(); i += 11) at[i].v = i % 2 == 0 ? 1 : 0.25;
    const auto evaluate = [&](std::size_t first, std::size_t count) {
      return surface.evaluate(Span<Location>(at).subspan(first, count), Derivatives::first, true);
    };
    const Evaluation all = evaluate(0, at.size());
    for (std::size_t first : {0, 1000, 2999}) {
      for (std::size_t row = first; row < std::min(first + 100, at.size()); ++row) {
        const Evaluation alone = evaluate(row, 1);
        const auto i = static_cast<Eigen::Index>(row);
        for (const auto member :
             {&Evaluation::position, &Evaluation::du, &Evaluation::dv, &Evaluation::normal}) {
          ASSERT_TRUE(sameBits((all.*member).row(i), alone.*member)) << describe(at[row]);
        }
      }
    }
  }
}

// Numbers below 0 are refused, and -0 is none of them.
TEST_P(Batch, NegativeZeroIsZero) {
  const LimitSurface surface = limitSurface(cage());
  for (int face = 0; face < surface.faceCount(); ++face) {
    const std::vector<Location> at = {{face, 0, 0}, {face, 0, 0.3}, {face, 0.3, 0},
                                      {face, 0, 1}, {face, 1, 0},   {face, 0, 0x1p-70}};
    std::vector<Location> negative = at;
    for (Location& l : negative) {
      l.u = l.u == 0 ? -0. : l.u;
      l.v = l.v == 0 ? -0. : l.v;
    }
    const Evaluation expected = surface.evaluate(at, Derivatives::first);
    const Evaluation got = surface.evaluate(negative, Derivatives::first);
    EXPECT_EQ(got.position, expected.position) << face;
    EXPECT_TRUE(((got.du - expected.du).array() == 0 || expected.du.array().isNaN()).all()) << face;
  }
}

INSTANTIATE_TEST_SUITE_P(Cages, Batch, testing::Values(0, 1, 2));

/// The sign of a zero parameter reaches no result, in which it could depend on the number of rows.
TEST(Batch, SignsOfZerosDoNotDependOnTheBatch) {
  const Cage cage = inTriangles(fullGrid(4, 4));
  const LimitSurface surface = limitSurface(cage);
  for (int face = 0; face < surface.faceCount(); ++face) {
    const std::vector<Location> three(3, {face, -0., 0.1}), one(1, three[0]);
    const Evaluation a = surface.evaluate(three, Derivatives::second, true);
    const Evaluation b = surface.evaluate(one, Derivatives::second, true);
    for (const auto& [of_three, of_one] : {std::pair{&a.position, &b.position},
                                           {&a.du, &b.du},
                                           {&a.dv, &b.dv},
                                           {&a.duu, &b.duu},
                                           {&a.duv, &b.duv},
                                           {&a.dvv, &b.dvv},
                                           {&a.normal, &b.normal}}) {
      EXPECT_EQ(std::memcmp(of_three->data(), of_one->data(), 3 * sizeof(double)), 0) << face;
    }
  }
}

// The batch is checked while it is evaluated, by tasks that end in any order.
/// The mesh has few rows on each face and enough of them that those on regular faces stay in the
/// order given, and only the others are sorted (RowOrder).
TEST(Batch, OrderDoesNotChangeABitOfManyRowsOnManyFaces) {
  constexpr int kSide = 60, kRows = 40'000;
  Random random(31);
  Cage cage = gridWithHoles(kSide, kSide, {5, 77, 78, 1000, 1061, 2500});
  for (Eigen::Index i = 0; i < cage.positions.rows(); ++i) {
    cage.positions.row(i) += random.vector(0.2);
  }
  const LimitSurface surface = limitSurface(cage);
  const int faces = static_cast<int>(ptexFaces(cage).size());
  std::vector<Location> mixed(kRows);
  for (Location& at : mixed) {
    at = {random.below(faces), random.uniform(), random.uniform()};
  }
  std::vector<int> order(mixed.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return mixed[a].face < mixed[b].face; });
  std::vector<Location> sorted;
  for (const int i : order) sorted.push_back(mixed[i]);
  const Evaluation a = surface.evaluate(mixed, Derivatives::second, true);
  const Evaluation b = surface.evaluate(sorted, Derivatives::second, true);
  for (const auto& [in_any, in_order] :
       {std::pair(&a.position, &b.position), std::pair(&a.du, &b.du), std::pair(&a.dv, &b.dv),
        std::pair(&a.duu, &b.duu), std::pair(&a.duv, &b.duv), std::pair(&a.dvv, &b.dvv),
        std::pair(&a.normal, &b.normal)}) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_EQ(
          std::memcmp(in_any->data() + 3 * order[i], in_order->data() + 3 * i, 3 * sizeof(double)),
          0)
          << describe(sorted[i]);
    }
  }
}

TEST(Batch, NamesTheFirstRowThatIsWrong) {
  const LimitSurface surface = limitSurface(cross());
  std::vector<Location> at = manyLocations(cross(), 30000);
  at[29000].u = 2;
  at[12345].v = -1;
  for (int threads : {1, 0, 5}) {
    try {
      surface.evaluate(at, Derivatives::first, true, threads);
      FAIL() << "no error";
    } catch (const LocationError& error) {
      EXPECT_EQ(std::string(error.what()).find("row 12345: "), 0u) << error.what();
    }
  }
}

// Where so many faces meet, all cores share the work on one vertex.
TEST(Batch, ThreadsDoNotChangeTheFacesAroundALargePole) {
  const Cage pole = fan(700, true, 1);
  LimitSurface surface = limitSurface(pole);
  const std::vector<Location> at = manyLocations(pole, 2000);
  surface.setPositions(pole.positions, 1);
  const Evaluation one = surface.evaluate(at, Derivatives::second, true);
  for (int threads : {0, 2, 7}) {
    surface.setPositions(pole.positions, threads);
    EXPECT_TRUE(sameBits(one, surface.evaluate(at, Derivatives::second, true)));
  }
}

TEST(Batch, EmptyOnesGiveEmptyResults) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> none;
  const Evaluation e = surface.evaluate(none, Derivatives::second, true);
  EXPECT_EQ(e.position.rows(), 0);
  EXPECT_EQ(e.normal.rows(), 0);
  EXPECT_EQ(surface.frames(none).rows(), 0);
  EXPECT_EQ(surface.curvature(none).gaussian.size(), 0);
  EXPECT_EQ(surface.stencils(none).offsets, LargePageVector<std::int64_t>{0});
}

TEST(SetPositions, RefusesWhatIsNotFiniteAndKeepsThePose) {
  LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = manyLocations(cross(), 100);
  const Evaluation before = surface.evaluate(at, Derivatives::second, true);
  Points bad = cross().positions;
  bad(4, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(surface.setPositions(bad), MeshError);
  EXPECT_THROW(surface.setPositions(cross().positions.topRows(11)), MeshError);
  EXPECT_TRUE(sameBits(before, surface.evaluate(at, Derivatives::second, true)));
  EXPECT_TRUE(sameBits(surface.positions(), cross().positions));
}

TEST(CheckPositions, FindsOneBadNumberAmongManyAndNamesTheFirstRow) {
  constexpr int kRows = 140'003;  // three parts, the last of which ends in an odd number of rows
  const Points good = Points::Random(kRows, 3);
  const double inf = std::numeric_limits<double>::infinity(), nan = inf - inf;
  for (const int threads : {1, 3}) {
    checkPositions(good, kRows, threads);
    for (const int row : {0, 1, 65'535, 65'536, 139'999, 140'000, 140'002}) {
      for (const double value : {nan, inf, -inf, 2 * kLargestCoordinate, -2 * kLargestCoordinate}) {
        Points bad = good;
        bad(row, row % 3) = value;
        bad(kRows - 1, 0) = nan;
        try {
          checkPositions(bad, kRows, threads);
          ADD_FAILURE() << row << ", " << value;
        } catch (const MeshError& error) {
          const std::string begin = "positions: vertex " + std::to_string(row) + " ";
          EXPECT_EQ(std::string(error.what()).substr(0, begin.size()), begin) << value;
        }
      }
    }
  }
}

TEST(CheckPositions, RefusesWhatIsTooSmall) {
  Points points = Points::Constant(7, 3, 5);
  checkPositions(points, 7, 1);
  points.setZero();
  points(6, 2) = kLeastExtent;
  checkPositions(points, 7, 1);
  points(6, 2) = kLeastExtent / 2;
  EXPECT_THROW(checkPositions(points, 7, 1), MeshError);
  checkPositions(Points(0, 3), 0, 1);
}

}  // namespace
}  // namespace limitsurf::test
