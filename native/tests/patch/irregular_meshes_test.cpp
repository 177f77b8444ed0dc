// SPDX-License-Identifier: Apache-2.0
//
// Faces with several irregular vertices, n-gons and random mixtures, against recursive subdivision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

void compareUnderAllRules(const std::string& name, Cage cage, const std::vector<int>& levels,
                          Accuracy& all, int count = 2) {
  Random random(7);
  const bool has_triangles = std::any_of(cage.faces.begin(), cage.faces.end(),
                                         [](const auto& face) { return face.size() == 3; });
  for (Boundary boundary : {Boundary::smooth, Boundary::corners}) {
    for (Triangles triangles : {Triangles::catmark, Triangles::smooth}) {
      if (triangles == Triangles::smooth && !has_triangles) continue;
      cage.options.boundary = boundary;
      cage.options.triangles = triangles;
      compareWithSubdivision(name, cage, everywhere(cage, levels, count, random), all);
    }
  }
}

TEST(IrregularMeshes, KnownShapesAgreeWithSubdivision) {
  Accuracy all("known shapes", 1);
  const std::vector<int> levels = {40};
  compareUnderAllRules("cross", cross(), levels, all);
  compareUnderAllRules("cube", perturbed(cube(), 0.2, 1), levels, all);
  compareUnderAllRules("tetrahedron", perturbed(tetrahedron(), 0.2, 2), levels, all);
  compareUnderAllRules("pentagonal tube", perturbed(prism(5, false), 0.2, 3), levels, all);
  compareUnderAllRules("triangular prism", perturbed(prism(3, true), 0.2, 4), levels, all);
  compareUnderAllRules("octagonal prism", perturbed(prism(8, true), 0.2, 5), levels, all);
  compareUnderAllRules("torus", perturbed(torus(5, 4), 0.2, 6), levels, all);
  compareUnderAllRules("interior valence 2", perturbed(valenceTwo(), 0.1, 7), levels, all);
  compareUnderAllRules("one quad", perturbed(grid(1, 1), 0.2, 8), levels, all);
  compareUnderAllRules("strip", perturbed(grid(4, 1), 0.2, 9), levels, all);
  compareUnderAllRules("holes", perturbed(gridWithHoles(5, 4, {6, 8, 12}), 0.2, 10), levels, all);
  std::printf("%s", all.details().c_str());
}

TEST(IrregularMeshes, LonelyPolygonsAgreeWithSubdivision) {
  Accuracy all("lonely polygons", 1);
  for (int sides : {3, 5, 6, 9, 20}) {
    Cage cage = ngon(sides, sides);
    cage.faces.resize(1);
    cage.positions.conservativeResize(sides, 3);
    compareUnderAllRules(std::to_string(sides) + "-gon", cage, {11, 40}, all);
  }
  std::printf("%s", all.details().c_str());
}

TEST(IrregularMeshes, PolygonsAgreeWithSubdivision) {
  Accuracy all("polygons", 1);
  for (int sides : {3, 4, 5, 6, 12}) {
    compareUnderAllRules(std::to_string(sides) + "-gon", ngon(sides, sides), {11, 40}, all);
  }
  std::printf("%s", all.details().c_str());
}

void compareMixtures(int first_seed, int count, const std::vector<int>& levels, int places) {
  Accuracy all("mixtures", 1);
  for (int seed = first_seed; seed < first_seed + count; ++seed) {
    compareUnderAllRules("mixture " + std::to_string(seed), mixture(seed), levels, all, places);
  }
  std::printf("%s", all.details().c_str());
}

TEST(IrregularMeshes, MixturesAgreeWithSubdivision) { compareMixtures(1, 1, {40}, 1); }

TEST(SlowIrregularMeshes, PolygonsAgreeWithSubdivision) {
  Accuracy all("polygons", 1);
  for (int sides : {3, 4, 5, 6, 7, 8, 9, 10, 16, 33, 50, 100}) {
    compareUnderAllRules(std::to_string(sides) + "-gon", ngon(sides, sides),
                         {1, 2, 3, 5, 8, 16, 24, 32, 40}, all);
  }
  std::printf("%s", all.details().c_str());
}

TEST(SlowIrregularMeshes, MixturesAgreeWithSubdivision) {
  compareMixtures(100, 5, {1, 2, 4, 8, 16, 28, 40}, 2);
}

}  // namespace
}  // namespace limitsurf::test
