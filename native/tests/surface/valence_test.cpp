// SPDX-License-Identifier: Apache-2.0
//
// Vertices of every valence to 100, against recursive subdivision.
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

enum class Kind { interior, smooth_boundary, pinned_boundary };

void compareFan(Kind kind, int valence, const std::vector<int>& levels, int random_locations,
                Accuracy& all) {
  const int faces = kind == Kind::interior ? valence : valence - 1;
  Cage cage = fan(faces, kind == Kind::interior, 1000 * static_cast<int>(kind) + valence);
  if (kind == Kind::pinned_boundary) cage.options.boundary = Boundary::corners;
  Random random(valence);
  const std::vector<Location> at = aroundFan(faces, levels, random_locations, random);
  const char* names[] = {"interior", "smooth boundary", "pinned boundary"};
  compareWithSubdivision(names[static_cast<int>(kind)] + (" valence " + std::to_string(valence)),
                         cage, at, all);
}

const std::vector<int> kSomeValences = {2,  3,  4,  5,  6,  7,  8,  9,  10,
                                        11, 12, 16, 25, 32, 50, 64, 100};
const std::vector<int> kSomeLevels = {1, 2, 3, 6, 10, 20, 40};

void compareSomeFans(Kind kind) {
  Accuracy all("fans", 1);
  for (int valence : kSomeValences) compareFan(kind, valence, kSomeLevels, 4, all);
  std::printf("%s", all.details().c_str());
}

TEST(Valence, InteriorVerticesAgreeWithSubdivision) { compareSomeFans(Kind::interior); }
TEST(Valence, SmoothBoundariesAgreeWithSubdivision) { compareSomeFans(Kind::smooth_boundary); }
TEST(Valence, PinnedBoundariesAgreeWithSubdivision) { compareSomeFans(Kind::pinned_boundary); }

void compareAllFans(Kind kind) {
  std::vector<int> levels(40);
  std::iota(levels.begin(), levels.end(), 1);
  Accuracy all("fans", 1);
  for (int valence = 2; valence <= 100; ++valence) compareFan(kind, valence, levels, 20, all);
  std::printf("%s", all.details().c_str());
}

TEST(SlowValence, InteriorVerticesAgreeWithSubdivision) { compareAllFans(Kind::interior); }
TEST(SlowValence, SmoothBoundariesAgreeWithSubdivision) { compareAllFans(Kind::smooth_boundary); }
TEST(SlowValence, PinnedBoundariesAgreeWithSubdivision) { compareAllFans(Kind::pinned_boundary); }

TEST(Valence, DerivativesAlongABoundaryAreTheLimitCurves) {
  for (int faces : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 31, 99}) {
    const Cage cage = fan(faces, false, faces);
    const LimitSurface surface = limitSurface(cage);
    const int first = 0, last = 4 * (faces - 1);
    const Vector3 vertex = cage.positions.row(cage.faces[first][0]);
    const Vector3 start = cage.positions.row(cage.faces[first][1]);
    const Vector3 end = cage.positions.row(cage.faces[last][3]);
    const std::vector<Location> at = {{first, 0, 0}, {last, 0, 0}};
    const Evaluation e = surface.evaluate(at, Derivatives::second);
    const double size = (start - end).norm() + (start + end - 2 * vertex).norm();
    EXPECT_LE((e.du.row(0).transpose() - (start - end) / 2).norm(), 1e-14 * size) << faces;
    EXPECT_LE((e.dv.row(1).transpose() - (end - start) / 2).norm(), 1e-14 * size) << faces;
    const Vector3 bend = start + end - 2 * vertex;
    EXPECT_LE((e.duu.row(0).transpose() - bend).norm(), 1e-14 * size) << faces;
    EXPECT_LE((e.dvv.row(1).transpose() - bend).norm(), 1e-14 * size) << faces;
    if (faces > 2) {
      EXPECT_TRUE(e.dv.row(0).array().isNaN().all() && e.dvv.row(0).array().isNaN().all());
      EXPECT_TRUE(e.du.row(1).array().isNaN().all() && e.duu.row(1).array().isNaN().all());
      EXPECT_TRUE(e.duv.array().isNaN().all());
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
