// SPDX-License-Identifier: Apache-2.0
//
// Cages that are no manifolds: what evaluates is what OpenSubdiv makes of them, what cannot is
// refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/throws.h"
#include "support/truth/corner_points.h"
#include "support/truth/far_limit.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// Compares positions on all faces that are not refused; refused ones throw an error that names
/// them. Interior vertices of valence 2 are left out, because OpenSubdiv's limit mask is wrong
/// there.
void expectAsOpenSubdivHasIt(const std::string& name, const Cage& cage,
                             const CornerPoints* corners) {
  const LimitSurface surface = limitSurface(cage);
  const FarLimit far = farLimit(cage, 4);
  std::vector<Location> at;
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(far.at.size()); ++i) {
    if (surface.refused().count(surface.baseFace()[far.at[i].face]) != 0) continue;
    const CornerPoint* corner = corners == nullptr ? nullptr : corners->at(far.at[i]);
    if (corner != nullptr && corner->rule == Rule::smooth && corner->faces == 2) continue;
    at.push_back(far.at[i]);
    rows.push_back(i);
  }
  const Points position = surface.evaluate(at).position;
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    ASSERT_LE((position.row(i) - far.position.row(rows[i])).norm(),
              (kPositionError + 2e-15) * diagonal(cage.positions))
        << name << ", " << describe(at[i]);
  }
  for (const auto& [face, reason] : surface.refused()) {
    EXPECT_FALSE(reason.empty()) << name << ", face " << face;
    const std::vector<int>& base = surface.baseFace();
    const int ptex = static_cast<int>(std::find(base.begin(), base.end(), face) - base.begin());
    const std::vector<Location> one = {{ptex, 0.5, 0.5}};
    expectThrow<MeshError>([&] { surface.evaluate(one); }, {std::to_string(ptex)});
  }
}

NamedCages allCages() {
  NamedCages cages = nonManifoldCages();
  for (auto& cage : fansOnACrease()) cages.push_back(std::move(cage));
  return cages;
}

TEST(NonManifold, NothingIsRefused) {
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    for (const auto& [face, reason] : surface.refused()) {
      ADD_FAILURE() << name << ", face " << face << ": " << reason;
    }
  }
}

TEST(NonManifold, PositionsAreOpenSubdivs) {
  for (auto& [name, cage] : allCages()) {
    for (const Boundary boundary : {Boundary::smooth, Boundary::corners}) {
      cage.options.boundary = boundary;
      const CornerPoints corners(cage);
      expectAsOpenSubdivHasIt(name, cage, &corners);
    }
  }
}

TEST(NonManifold, EverythingAgreesWithSubdivision) {
  Accuracy all("non-manifold", 1);
  Random random(1);
  int number = 0;
  for (auto& [name, cage] : allCages()) {
    cage.options.boundary = number++ % 2 == 0 ? Boundary::smooth : Boundary::corners;
    compareWithSubdivision(name, cage, hereAndThere(cage, {3, 20, 40}, 2, random), all);
  }
  std::printf("%s", all.details().c_str());
}

void compareSharpened(int rounds, int count) {
  Accuracy all("sharp and non-manifold", 1);
  Random random(2);
  int number = 0;
  for (int round = 0; round < rounds; ++round) {
    for (auto& [name, cage] : allCages()) {
      cage.options.creasing = number++ % 2 == 0 ? Creasing::uniform : Creasing::chaikin;
      sharpenAtRandom(cage, random, 3, 5, {0.3, 1, 1.5, 2.7, 5.25, 10});
      compareWithSubdivision(name, cage, hereAndThere(cage, {3, 20, 40}, count, random), all);
    }
  }
  std::printf("%s", all.details().c_str());
}

TEST(NonManifold, SharpnessAgreesWithSubdivision) { compareSharpened(1, 1); }
TEST(SlowNonManifold, SharpnessAgreesWithSubdivision) { compareSharpened(8, 3); }

TEST(NonManifold, FacesWithAVertexTwiceAreRefusedAndTheirNeighboursAreNot) {
  for (const std::vector<int>& corners : std::vector<std::vector<int>>{{0, 1, 2, 1},
                                                                       {0, 1, 0, 3},
                                                                       {0, 0, 1, 2},
                                                                       {0, 1, 1, 2},
                                                                       {0, 0, 1},
                                                                       {0, 1, 1, 0},
                                                                       {0, 0, 0, 0},
                                                                       {0, 1, 2, 3, 1}}) {
    Cage cage = gridWithFace(corners);
    for (const Boundary boundary : {Boundary::smooth, Boundary::corners}) {
      cage.options.boundary = boundary;
      const LimitSurface surface = limitSurface(cage);
      std::string name = "face with corners";
      for (int corner : corners) name += " " + std::to_string(corner);
      EXPECT_EQ(surface.refused().size(), 1u) << name;
      ASSERT_EQ(surface.refused().count(5), 1u) << name;
      EXPECT_NE(surface.refused().at(5).find("twice"), std::string::npos);
      expectAsOpenSubdivHasIt(name, cage, nullptr);
    }
  }
}

TEST(NonManifold, RefusedFacesWithAVertexTwiceMayTouchNothing) {
  // [a, b, a, c] beyond one vertex of a grid.
  Cage cage = perturbed(grid(3, 3), 0.1, 1);
  const int first = cage.vertexCount();
  cage.positions.conservativeResize(first + 2, 3);
  cage.positions.bottomRows(2) << 5, 5, 0, 6, 6, 1;
  for (int vertex : {0, cage.faces[4][0]}) {
    Cage touching = cage;
    touching.faces.push_back({vertex, first, vertex, first + 1});
    const LimitSurface surface = limitSurface(touching);
    EXPECT_EQ(surface.refused().size(), 1u);
    EXPECT_EQ(surface.refused().count(9), 1u);
    expectAsOpenSubdivHasIt("two vertices twice", touching, nullptr);
  }
}

TEST(NonManifold, LeftHandedMeshesAreLikeOthers) {
  Random random(3);
  Accuracy all("clockwise", 1);
  for (const Cage& plain : {mixture(4), perturbed(prism(5, true), 0.2, 1)}) {
    Cage cage = reversed(plain);
    sharpenAtRandom(cage, random, 3, 5, {0.5, 2, 10});
    compareWithSubdivision("clockwise", cage, hereAndThere(cage, {3, 30}, 1, random), all);
  }
}

TEST(NonManifold, FacesOfManyIrregularVertices) {
  // A face of 24 sides whose corners are all irregular; some are sharp, some are on fins.
  Random random(4);
  Accuracy all("24-gon", 1);
  Cage cage = ngon(24, 1);
  compareWithSubdivision("plain", cage, hereAndThere(cage, {3, 30}, 1, random), all);
  const int first = cage.vertexCount();
  cage.positions.conservativeResize(first + 2, 3);
  cage.positions.bottomRows(2) << 1, 0, 1, 1, 0.3, 1;
  cage.faces.push_back({0, 1, first + 1, first});
  sharpenAtRandom(cage, random, 3, 3, {0.5, 2.5, 10});
  compareWithSubdivision("sharp, with a fin", cage, hereAndThere(cage, {3, 30}, 1, random), all);
}

TEST(NonManifold, HolesKeepTheirPlaceInTheTopology) {
  // A hole still is a face for its neighbours, so that an edge keeps its three faces.
  for (const auto& [name, plain] : allCages()) {
    if (plain.faces.size() < 3) continue;
    Cage cage = plain;
    const int hole = static_cast<int>(cage.faces.size()) - 1;
    cage.options.holes = {hole};
    const LimitSurface surface = limitSurface(cage), whole = limitSurface(plain);
    ASSERT_EQ(surface.refused().size(), 1u) << name;
    std::vector<Location> at;
    for (int face = 0; face < surface.faceCount(); ++face) {
      if (surface.baseFace()[face] != hole) at.push_back({face, 0.3, 0.7});
    }
    EXPECT_EQ(surface.evaluate(at).position, whole.evaluate(at).position) << name;
  }
}

}  // namespace
}  // namespace limitsurf::test
