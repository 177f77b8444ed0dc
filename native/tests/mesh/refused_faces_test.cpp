// SPDX-License-Identifier: Apache-2.0
//
// Faces without a limit surface do not spoil the others.
#include <gtest/gtest.h>

#include <algorithm>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/meshes.h"
#include "support/random.h"
#include "support/throws.h"

namespace limitsurf::test {
namespace {

/// A valid 4x4 grid, and beside it a 3x3 grid, with no vertex in common, that `spoil` may change.
/// The faces of the second grid follow the first grid's 16, its vertices the first grid's 25.
template <typename Spoil>
Cage besideAGrid(const Spoil& spoil) {
  Cage cage = perturbed(grid(4, 4), 0.1, 1);
  const Cage other = perturbed(grid(3, 3), 0.1, 2);
  const int shift = cage.vertexCount();
  cage.positions.conservativeResize(shift + other.vertexCount(), 3);
  cage.positions.bottomRows(other.vertexCount()) =
      other.positions.rowwise() + Eigen::RowVector3d(10, 0, 0);
  for (std::vector<int> face : other.faces) {
    for (int& vertex : face) vertex += shift;
    cage.faces.push_back(face);
  }
  spoil(cage);
  return cage;
}

/// An error names each refused face that is evaluated; all others are as they would be alone.
void expectRefusedBesideAGrid(const Cage& cage, int refused_face,
                              const std::vector<std::string>& reason) {
  const LimitSurface surface = limitSurface(cage);
  const LimitSurface alone = limitSurface(perturbed(grid(4, 4), 0.1, 1));
  ASSERT_EQ(surface.refused().count(refused_face), 1u);
  for (const std::string& part : reason) {
    EXPECT_NE(surface.refused().at(refused_face).find(part), std::string::npos)
        << surface.refused().at(refused_face);
  }

  Random random(1);
  std::vector<Location> at;
  for (int face = 0; face < 16; ++face) {
    EXPECT_EQ(surface.refused().count(face), 0u);
    at.push_back({face, random.uniform(), random.uniform()});
    at.push_back({face, 0, 0});
  }
  EXPECT_EQ(surface.evaluate(at).position, alone.evaluate(at).position);

  const std::vector<int>& base = surface.baseFace();
  for (int face = 0; face < surface.faceCount(); ++face) {
    const std::vector<Location> one = {{face, 0.25, 0.5}};
    if (surface.refused().count(base[face]) == 0) {
      EXPECT_TRUE(surface.evaluate(one).position.allFinite());
      continue;
    }
    std::vector<Location> batch = at;
    batch.insert(batch.begin() + 5, one[0]);
    const std::string id = std::to_string(face);
    expectThrow<MeshError>([&] { surface.evaluate(batch); }, {id});
    expectThrow<MeshError>([&] { surface.evaluate(one, Derivatives::second, true); }, {id});
    expectThrow<MeshError>([&] { surface.frames(one); }, {id});
    expectThrow<MeshError>([&] { surface.curvature(one); }, {id});
    expectThrow<MeshError>([&] { surface.stencils(one, true); }, {id});
  }
  for (const Location& location : scatterJittered(surface, 2, 1)) {
    EXPECT_EQ(surface.refused().count(base[location.face]), 0u);
  }
  for (const Location& location : tessellate(surface, 2).locations) {
    EXPECT_EQ(surface.refused().count(base[location.face]), 0u);
  }
  const std::vector<Location> vertices = surface.vertexLocations();
  ASSERT_EQ(static_cast<int>(vertices.size()), cage.vertexCount());
  for (const Location& location : vertices) {
    if (location.face < 0) continue;
    EXPECT_EQ(surface.refused().count(base[location.face]), 0u);
  }
  EXPECT_GT(surfaceArea(surface), surfaceArea(alone) * (1 - 1e-9));
  EXPECT_TRUE(surface.bounds().allFinite());
}

TEST(RefusedFaces, NoneInASoundMesh) {
  EXPECT_TRUE(limitSurface(mixture(1)).refused().empty());
  EXPECT_TRUE(limitSurface(valenceTwo()).refused().empty());
}

TEST(RefusedFaces, WhereAFaceUsesAVertexTwice) {
  const Cage cage = besideAGrid([](Cage& c) {
    const std::vector<int> last = c.faces.back();
    c.faces.back() = {last[0], last[1], last[2], last[1], last[3]};
  });
  const int face = static_cast<int>(cage.faces.size()) - 1;
  expectRefusedBesideAGrid(cage, face, {std::to_string(cage.faces[face][1])});
}

TEST(RefusedFaces, WhereAQuadIsDegenerate) {
  const Cage cage = besideAGrid([](Cage& c) { c.faces.back()[3] = c.faces.back()[2]; });
  expectRefusedBesideAGrid(cage, static_cast<int>(cage.faces.size()) - 1, {});
}

/// Nothing is refused, and the valid grid is as it would be alone.
void expectAcceptedBesideAGrid(const Cage& cage) {
  const LimitSurface surface = limitSurface(cage);
  EXPECT_TRUE(surface.refused().empty());
  std::vector<Location> at;
  for (int face = 0; face < 16; ++face) at.push_back({face, 0.3, 0.6});
  const LimitSurface alone = limitSurface(perturbed(grid(4, 4), 0.1, 1));
  EXPECT_EQ(surface.evaluate(at).position, alone.evaluate(at).position);
  at.clear();
  for (int face = 0; face < surface.faceCount(); ++face) at.push_back({face, 0.3, 0.6});
  EXPECT_TRUE(surface.evaluate(at).position.allFinite());
  for (const Location& location : surface.vertexLocations()) EXPECT_GE(location.face, 0);
}

TEST(RefusedFaces, NotWhereAnEdgeHasThreeFaces) {
  expectAcceptedBesideAGrid(besideAGrid([](Cage& c) {
    const int more = c.vertexCount();
    c.positions.conservativeResize(more + 2, 3);
    c.positions.bottomRows(2) << 11, 1, 3, 12, 1, 3;
    // A wing on the edge between the second grid's first and second row.
    const int a = c.faces[16 + 4][0], b = c.faces[16 + 4][1];
    c.faces.push_back({a, b, more + 1, more});
  }));
}

TEST(RefusedFaces, NotWhereNeighboursHaveOppositeWinding) {
  expectAcceptedBesideAGrid(
      besideAGrid([](Cage& c) { std::reverse(c.faces[16 + 4].begin(), c.faces[16 + 4].end()); }));
}

TEST(RefusedFaces, NotWhereAClosedFanMeetsOthers) {
  expectAcceptedBesideAGrid(besideAGrid([](Cage& c) {
    const int tip = c.faces[16 + 4][0], first = c.vertexCount();
    c.positions.conservativeResize(first + 4, 3);
    c.positions.bottomRows(4) << 11, 0, 3, 12, 0, 3, 12, 1, 3, 11, 1, 3;
    for (int i = 0; i < 4; ++i) c.faces.push_back({tip, first + i, first + (i + 1) % 4});
  }));
}

TEST(RefusedFaces, HolesAreThereForTheirNeighbours) {
  Cage cage = perturbed(grid(4, 4), 0.2, 1);
  std::vector<Location> at;
  Random random(2);
  for (int face = 0; face < 16; ++face) {
    if (face != 5 && face != 15) at.push_back({face, random.uniform(), random.uniform()});
  }
  const Points whole = limitSurface(cage).evaluate(at).position;
  cage.options.holes = {5, 15};
  const LimitSurface surface = limitSurface(cage);
  EXPECT_EQ(surface.refused().size(), 2u);
  EXPECT_EQ(surface.faceCount(), 16);
  EXPECT_EQ(surface.evaluate(at).position, whole);
  expectThrow<MeshError>(
      [&] {
        const std::vector<Location> hole = {{0, 0.5, 0.5}, {5, 0.5, 0.5}};
        surface.evaluate(hole);
      },
      {"5"});
  EXPECT_EQ(scatterJittered(surface, 3, 1).size(), 14u * 9);
}

TEST(RefusedFaces, KeepTheirPtexIds) {
  Cage cage = perturbed(grid(3, 1), 0.1, 1);
  cage.faces[1] = {cage.faces[1][0], cage.faces[1][1], cage.faces[1][2]};
  cage.options.holes = {1};
  const LimitSurface surface = limitSurface(cage);
  EXPECT_EQ(surface.faceCount(), 5);
  EXPECT_EQ(surface.baseFace(), (std::vector<int>{0, 1, 1, 1, 2}));
  EXPECT_EQ(surface.corner(), (std::vector<int>{0, 0, 1, 2, 0}));
}

TEST(RefusedFaces, NotAtBowTies) {
  // Two fans meet in one vertex. OpenSubdiv makes it infinitely sharp, so that each fan has a
  // surface.
  Cage cage = perturbed(gridWithHoles(4, 4, {6, 9}), 0.1, 1);
  for (Boundary boundary : {Boundary::smooth, Boundary::corners}) {
    cage.options.boundary = boundary;
    const LimitSurface surface = limitSurface(cage);
    EXPECT_TRUE(surface.refused().empty());
    const Eigen::RowVector3d between(2, 2, 0);  // between the holes
    int vertex;
    (cage.positions.rowwise() - between).rowwise().norm().minCoeff(&vertex);
    for (int face = 0; face < static_cast<int>(cage.faces.size()); ++face) {
      for (int corner = 0; corner < 4; ++corner) {
        if (cage.faces[face][corner] != vertex) continue;
        const std::vector<Location> at = {cornerLocation(face, corner)};
        EXPECT_LE((surface.evaluate(at).position - cage.positions.row(vertex)).norm(), 1e-14);
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
