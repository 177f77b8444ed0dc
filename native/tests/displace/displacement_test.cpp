// SPDX-License-Identifier: Apache-2.0
//
// Displacement between surfaces whose difference is known, and the reading of images of it.
#include "limitsurf/displace/displacement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "limitsurf/displace/ptex_layout.h"
#include "limitsurf/image/bilinear_image.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"
#include "support/throws.h"
#include "support/truth/far_refinement.h"

namespace limitsurf::test {
namespace {

std::vector<Location> randomLocations(int faces, int count, Random& random) {
  std::vector<Location> at;
  for (int i = 0; i < count; ++i) {
    at.push_back({random.below(faces), random.uniform(), random.uniform()});
  }
  return at;
}

FrameRows randomFrames(Eigen::Index rows, Random& random) {
  FrameRows frames(rows, 9);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Vector3 axis = random.vector(1).normalized();
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> frame =
        Eigen::AngleAxisd(random.uniform(0, 6), axis).toRotationMatrix();
    if (row % 2 == 1) frame.col(1) *= -1;  // as where a map is mirrored
    frames.row(row) = Eigen::Map<const Eigen::Matrix<double, 1, 9>>(frame.data());
  }
  return frames;
}

TEST(Displacement, VectorsAreTheDifferenceOfLimitPoints) {
  // The target is the base's subdivision under an affine map, so its surface is the base's.
  Random random(1);
  Eigen::Matrix3d map;
  map << 1.2, 0.1, 0, -0.2, 0.9, 0.3, 0, 0.1, 1.1;
  const Eigen::RowVector3d shift(0.3, -1, 2);
  for (int seed = 1; seed <= 4; ++seed) {
    Cage cage = mixture(seed);
    sharpenAtRandom(cage, random, 3, 5, {0.5, 1, 2.25, 10});
    const LimitSurface base = limitSurface(cage);
    const std::vector<Location> at = randomLocations(base.faceCount(), 300, random);
    const Points here = base.evaluate(at).position;
    const Points expected = (here * map.transpose()).rowwise() + shift - here;
    for (int levels : {0, 1, 2}) {
      Cage target_cage = levels == 0 ? cage : subdivided(cage, levels);
      target_cage.positions = ((target_cage.positions * map.transpose()).rowwise() + shift).eval();
      const LimitSurface target = limitSurface(target_cage);
      const SubdividedFaces faces(base.mesh(), target.mesh());
      const Points found = vectorDisplacement(base, target, faces, at);
      Points both(cage.positions.rows() + target_cage.positions.rows(), 3);
      both << cage.positions, target_cage.positions;
      EXPECT_LE((found - expected).rowwise().norm().maxCoeff(),
                kDisplacementError * diagonal(both));
      const FrameRows frames = randomFrames(found.rows(), random);
      EXPECT_LE((displaced(base, at, intoFrames(found, frames), frames) - here - expected)
                    .rowwise()
                    .norm()
                    .maxCoeff(),
                2 * kDisplacementError * diagonal(both));
    }
  }
}

TEST(Displacement, ComponentsAreAlongTangentNormalBitangent) {
  FrameRows frames(1, 9);  // columns y, z, x
  frames << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Points vector(1, 3), expected(1, 3);
  vector << 7, 8, 9;
  expected << 8, 7, 9;  // along y, x, z
  EXPECT_EQ(intoFrames(vector, frames), expected);
  EXPECT_EQ(outOfFrames(expected, frames), vector);
  expectThrow<std::invalid_argument>([&] { intoFrames(Points(2, 3), frames); },
                                     {"2 vectors and 1 frames"});
}

TEST(Displacement, DistancesLeadToTheTarget) {
  Random random(2);
  const LimitSurface base = limitSurface(perturbed(prism(5, true), 0.1, 1));
  Cage around = perturbed(prism(5, true), 0.1, 2);
  around.positions *= 1.6;
  const LimitSurface target = limitSurface(around);
  const SurfaceSearch search(target);
  const std::vector<Location> at = randomLocations(base.faceCount(), 500, random);
  const Eigen::VectorXd distances = scalarDisplacement(base, search, at);
  EXPECT_TRUE(distances.allFinite());
  const Points there = displacedAlongNormals(base, at, distances);
  EXPECT_LE(search.closest(there).distance.maxCoeff(), 1e-11);

  ScalarDisplacementOptions options;
  options.max_distance = 0.5 * distances.cwiseAbs().maxCoeff();
  const Eigen::VectorXd near = scalarDisplacement(base, search, at, options);
  for (Eigen::Index row = 0; row < near.size(); ++row) {
    EXPECT_EQ(std::isnan(near[row]), std::abs(distances[row]) > options.max_distance);
  }
  options.max_distance = std::numeric_limits<double>::infinity();
  options.direction = RayDirection::outward;
  const Eigen::VectorXd outward = scalarDisplacement(base, search, at, options);
  options.direction = RayDirection::inward;
  const Eigen::VectorXd inward = scalarDisplacement(base, search, at, options);
  for (Eigen::Index row = 0; row < near.size(); ++row) {
    EXPECT_FALSE(outward[row] < 0 || inward[row] > 0);
    EXPECT_EQ(distances[row], -inward[row] < outward[row] ? inward[row] : outward[row]);
  }
}

TEST(Displacement, ThreadsDoNotChangeABit) {
  Random random(3);
  const LimitSurface base = limitSurface(mixture(5));
  const LimitSurface target = limitSurface(subdivided(mixture(5), 1));
  const SubdividedFaces faces(base.mesh(), target.mesh());
  const std::vector<Location> at = randomLocations(base.faceCount(), 20000, random);
  EXPECT_EQ(vectorDisplacement(base, target, faces, at, 1),
            vectorDisplacement(base, target, faces, at, 3));
}

TEST(BilinearImage, ReadsPixelsAtTheirCentresAndMixesThemBetween) {
  const std::vector<float> pixels = {0, 1, 2, 10, 11, 12};  // 3 x 2
  const BilinearImage image{pixels.data(), 3, 2, 1};
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> places(5, 2);
  places << 1 / 6., 1 / 4., 5 / 6., 3 / 4., 0.5, 0.5, -9, 1 / 4., 9, 9;
  const DataRows found = image.sample(places);
  const double expected[] = {0, 12, 6, 0, 12};
  for (int row = 0; row < 5; ++row) EXPECT_NEAR(found(row, 0), expected[row], 1e-12);
}

TEST(PtexLayout, ATileHasItsFacesSamples) {
  const PtexLayout layout(5, 4);
  EXPECT_EQ(layout.columns(), 3);
  EXPECT_EQ(layout.width(), 15);
  EXPECT_EQ(layout.height(), 10);
  const std::vector<PtexLayout::Pixel> pixels = layout.pixels();
  const std::vector<Location> at = layout.locations();
  ASSERT_EQ(pixels.size(), 125u);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto place = layout.mapCoordinates({&at[i], 1});
    EXPECT_NEAR(place(0, 0) * 15, pixels[i].x + 0.5, 1e-12);
    EXPECT_NEAR(place(0, 1) * 10, pixels[i].y + 0.5, 1e-12);
    EXPECT_EQ(pixels[i].x, at[i].face % 3 * 5 + 4 * at[i].u);
    EXPECT_EQ(pixels[i].y, at[i].face / 3 * 5 + 4 * at[i].v);
  }
}

}  // namespace
}  // namespace limitsurf::test
