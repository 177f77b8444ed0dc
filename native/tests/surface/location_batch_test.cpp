// SPDX-License-Identifier: Apache-2.0
//
// Batches refer to locations, or to arrays of faces and of (u, v); results go to the caller's
// arrays.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "limitsurf/error.h"
#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

const std::vector<double> kParameters = {0.25, 0.5, 1, 0, 0.125, 0.75};

template <typename Error, typename Call>
std::string errorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

template <typename Face>
void expectSameResults() {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{3, 0.25, 0.5}, {0, 1, 0}, {4, 0.125, 0.75}};
  const std::vector<Face> faces = {3, 0, 4};
  const LocationBatch batch(Span<Face>(faces), kParameters);
  ASSERT_EQ(batch.size(), 3u);
  EXPECT_EQ(surface.evaluate(batch).position, surface.evaluate(at).position);
  EXPECT_EQ(surface.evaluate(batch.rows(1, 2)).position,
            surface.evaluate(at).position.bottomRows(2));
  EXPECT_EQ(surface.frames(batch), surface.frames(at));
}

TEST(LocationBatch, ReadsArrays) {
  expectSameResults<std::int32_t>();
  expectSameResults<std::int64_t>();
}

TEST(LocationBatch, HasOneFaceForAllRows) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<std::int64_t> face = {2};
  const LocationBatch batch(face, kParameters);
  ASSERT_EQ(batch.size(), 3u);
  const std::vector<Location> at = {{2, 0.25, 0.5}, {2, 1, 0}, {2, 0.125, 0.75}};
  EXPECT_EQ(surface.evaluate(batch).position, surface.evaluate(at).position);
}

TEST(LocationBatch, RefusesOtherNumbersOfFaces) {
  const std::vector<std::int32_t> two = {1, 2}, none;
  const auto batch = [](const auto& faces, const std::vector<double>& uv) {
    return errorOf<std::invalid_argument>([&] { LocationBatch(Span<std::int32_t>(faces), uv); });
  };
  EXPECT_EQ(batch(two, kParameters),
            "there are 2 faces and 6 numbers of (u, v); expected two numbers for each face, or one "
            "face for all");
  EXPECT_NE(batch(none, kParameters), "no error");
  EXPECT_NE(batch(two, {0.5, 0.5, 0.5}), "no error");
  EXPECT_EQ(batch(none, {}), "no error");
}

TEST(LocationBatch, NamesFacesThatDoNotFitIntoAnInt) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<std::int64_t> faces = {0, (std::int64_t{1} << 32) + 1, 0};
  EXPECT_EQ(errorOf<LocationError>([&] { surface.evaluate({faces, kParameters}); }),
            "row 1: face 4294967297 is not among the 5 Ptex faces");
}

TEST(LocationBatch, ChangedAfterItsCheckIsRefused) {
  const LimitSurface surface = limitSurface(cross());
  for (std::size_t size : {std::size_t{3}, std::size_t{10000}}) {
    std::vector<std::int64_t> faces(size);
    std::vector<double> uv(2 * size, 0.5);
    for (std::size_t row = 0; row < size; ++row) {
      faces[row] = static_cast<std::int64_t>(row % 5);
    }
    const LocationBatch checked = surface.checkLocations({faces, uv});
    for (std::int64_t bad : {std::int64_t{5}, std::int64_t{-1}, std::int64_t{1} << 30}) {
      faces[size / 2] = bad;
      EXPECT_THROW(surface.evaluate(checked), LocationError);
      faces[size / 2] = 0;
    }
    for (double bad : {-0.5, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
      uv[size] = bad;
      EXPECT_THROW(surface.evaluate(checked), LocationError);
      uv[size] = 0.5;
    }
    EXPECT_EQ(surface.evaluate(checked).position.rows(), static_cast<Eigen::Index>(size));
  }
}

TEST(EvaluationArrays, AreFilled) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{3, 0.25, 0.5}, {0, 1, 0}, {4, 0.125, 0.75}};
  const Evaluation expected = surface.evaluate(at, Derivatives::first, true);
  Points position(3, 3), du(3, 3), dv(3, 3), normal = Points::Constant(3, 3, 7);
  EvaluationArrays<double> arrays{{position.data(), 3}, {du.data(), 3}, {dv.data(), 3}};
  surface.evaluate(at, Derivatives::first, arrays);
  EXPECT_EQ(position, expected.position);
  EXPECT_EQ(du, expected.du);
  EXPECT_EQ(dv, expected.dv);
  EXPECT_EQ(normal, Points::Constant(3, 3, 7));
}

TEST(EvaluationArrays, OfAnotherSizeAreRefused) {
  const LimitSurface surface = limitSurface(cross());
  const std::vector<Location> at = {{3, 0.25, 0.5}, {0, 1, 0}};
  Points position = Points::Constant(2, 3, 7), du(2, 3), short_one(1, 3);
  const EvaluationArrays<double> without_dv{{position.data(), 2}, {du.data(), 2}};
  EXPECT_EQ(
      errorOf<std::invalid_argument>([&] { surface.evaluate(at, Derivatives::first, without_dv); }),
      "dv has 0 rows; expected 2");
  EXPECT_EQ(position, Points::Constant(2, 3, 7));
  const EvaluationArrays<double> too_short{{short_one.data(), 1}};
  EXPECT_EQ(
      errorOf<std::invalid_argument>([&] { surface.evaluate(at, Derivatives::none, too_short); }),
      "position has 1 row; expected 2");
}

}  // namespace
}  // namespace limitsurf::test
