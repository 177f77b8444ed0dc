// SPDX-License-Identifier: Apache-2.0
//
// Meshes of all kinds with sharp edges and vertices, against recursive subdivision.
#include "support/cages/sharp_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

const std::vector<double> kValues = {0, 0.3, 1, 1.5, 2.7, 3, 5.25, 9.9, 10, INFINITY};

struct Named {
  std::string name;
  Cage cage;
};

std::vector<Named> someCages(int mixtures) {
  std::vector<Named> cages = {{"cube", perturbed(cube(), 0.2, 1)},
                              {"tetrahedron", perturbed(tetrahedron(), 0.2, 2)},
                              {"prism", perturbed(prism(7, true), 0.2, 3)},
                              {"tube", perturbed(prism(5, false), 0.2, 4)},
                              {"torus", perturbed(torus(5, 4), 0.2, 5)},
                              {"grid", perturbed(grid(4, 3), 0.2, 6)},
                              {"one quad", perturbed(grid(1, 1), 0.2, 7)},
                              {"holes", perturbed(gridWithHoles(5, 4, {6, 8, 12}), 0.2, 8)},
                              {"bow-tie", perturbed(gridWithHoles(4, 4, {5, 10}), 0.2, 9)},
                              {"cross", perturbed(cross(), 0.1, 12)},
                              {"polygon", ngon(6, 10)},
                              {"interior valence 2", perturbed(valenceTwo(), 0.1, 11)}};
  for (int seed = 1; seed <= mixtures; ++seed) {
    cages.push_back({"mixture " + std::to_string(seed), mixture(20 + seed)});
  }
  return cages;
}

/// The `number`th combination of creasing, boundary and triangle rules.
std::string setRules(Cage& cage, int number) {
  cage.options.creasing = number % 2 == 0 ? Creasing::uniform : Creasing::chaikin;
  cage.options.boundary = number / 2 % 2 == 0 ? Boundary::smooth : Boundary::corners;
  cage.options.triangles = number / 4 % 2 == 0 ? Triangles::catmark : Triangles::smooth;
  return std::string(number % 2 == 0 ? ", uniform" : ", chaikin") +
         (number / 2 % 2 == 0 ? ", smooth" : ", corners") +
         (number / 4 % 2 == 0 ? "" : ", smooth triangles");
}

void compareSharpened(int mixtures, int first_rules, int rules_each, int rules_step, int count,
                      const std::vector<int>& levels, const std::vector<double>& values) {
  Accuracy all("sharp meshes", 1);
  Random random(3);
  int number = first_rules;
  for (const auto& [name, plain] : someCages(mixtures)) {
    for (int repeated = 0; repeated < rules_each; ++repeated, number += rules_step) {
      Cage cage = plain;
      const std::string rules = setRules(cage, number);
      sharpenAtRandom(cage, random, 1 + random.below(4), 2 + random.below(6), values);
      compareWithSubdivision(name + rules, cage, hereAndThere(cage, levels, count, random), all);
    }
  }
  std::printf("%s", all.details().c_str());
}

TEST(SharpMeshes, OfAnySharpnessAgreeWithSubdivision) {
  compareSharpened(3, 0, 1, 3, 1, {2, 6, 20, 40}, kValues);
}

TEST(SharpMeshes, OfInfiniteSharpnessAgreeWithSubdivision) {
  compareSharpened(3, 1, 1, 3, 2, {2, 6, 20, 40}, {10});
}

TEST(SharpMeshes, OfFractionalSharpnessAgreeWithSubdivision) {
  compareSharpened(2, 2, 1, 3, 1, {2, 6, 20, 40}, {0.3, 0.7, 1, 1.2, 1.5});
}

TEST(SlowSharpMeshes, OfAnySharpnessAgreeWithSubdivision) {
  compareSharpened(10, 0, 8, 1, 4, {1, 2, 3, 5, 8, 11, 14, 20, 30, 40}, kValues);
}

TEST(SlowSharpMeshes, OfInfiniteSharpnessAgreeWithSubdivision) {
  compareSharpened(20, 1, 8, 1, 6, {1, 2, 3, 6, 12, 20, 40}, {10});
}

TEST(SlowSharpMeshes, OfFractionalSharpnessAgreeWithSubdivision) {
  compareSharpened(10, 2, 8, 1, 4, {1, 2, 3, 5, 12, 20, 40}, {0.1, 0.3, 0.7, 1, 1.2, 1.5, 2});
}

TEST(SlowSharpMeshes, WithAllEdgesSharpAgreeWithSubdivision) {
  Accuracy all("all edges", 1);
  Random random(4);
  int number = 0;
  for (const auto& [name, plain] : someCages(1)) {
    for (const double sharpness : {0.4, 2.75, 10.0}) {
      Cage cage = plain;
      const std::string rules = setRules(cage, number++);
      for (const auto& [a, b] : edgesOf(cage)) sharpenEdge(cage, a, b, sharpness);
      compareWithSubdivision(name + rules + ", all " + std::to_string(sharpness), cage,
                             hereAndThere(cage, {2, 20, 40}, 1, random), all);
    }
  }
  std::printf("%s", all.details().c_str());
}

TEST(SharpMeshes, SingleCreasesAgreeWithSubdivision) {
  // The creases are in the middle of a grid, so that the faces beside them have no other
  // irregularity: one runs straight through, one ends inside, one turns, and two are next to each
  // other.
  const Cage plain = perturbed(grid(6, 5), 0.2, 12);
  const auto vertex = [&](int i, int j) {
    int found;
    (plain.positions.rowwise() - Eigen::RowVector3d(i, j, 0)).rowwise().norm().minCoeff(&found);
    return found;
  };
  const std::vector<std::vector<std::pair<int, int>>> runs = {
      {{0, 2}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {5, 2}, {6, 2}},
      {{1, 2}, {2, 2}, {3, 2}, {4, 2}},
      {{1, 1}, {2, 1}, {3, 1}, {3, 2}, {3, 3}},
      {{2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 1}}};
  Accuracy all("single creases", 1);
  Random random(5);
  for (const double sharpness :
       {1e-30, 1e-6, 0.5, 0.999, 1.0, 1.0001, 2.0, 3.0, 4.5, 6.0, 7.3, 8.0, 9.0, 9.999, 10.0}) {
    for (std::size_t run = 0; run < runs.size(); ++run) {
      Cage cage = plain;
      cage.options.creasing = run % 2 == 0 ? Creasing::uniform : Creasing::chaikin;
      for (std::size_t i = 0; i + 1 < runs[run].size(); ++i) {
        sharpenEdge(cage, vertex(runs[run][i].first, runs[run][i].second),
                    vertex(runs[run][i + 1].first, runs[run][i + 1].second), sharpness);
      }
      compareWithSubdivision("run " + std::to_string(run) + " of " + std::to_string(sharpness),
                             cage, hereAndThere(cage, {1, 3, 7, 11, 25}, 1, random), all);
    }
  }
  std::printf("%s", all.details().c_str());
}

}  // namespace
}  // namespace limitsurf::test
