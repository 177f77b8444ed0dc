// SPDX-License-Identifier: Apache-2.0
//
// The same places on a mesh and on its subdivisions, which OpenSubdiv makes, in its own order of
// faces and in Blender's.
#include "limitsurf/displace/subdivided_faces.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "limitsurf/error.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/random.h"
#include "support/throws.h"
#include "support/truth/far_refinement.h"

namespace limitsurf::test {
namespace {

/// One face of the grid that a subdivided face becomes: part (Ptex face, counted from the face's
/// first), column and row.
struct Cell {
  int part, i, j;
};

/// Blender's order of faces, by Blender's own loops.
std::vector<Cell> blendersCells(int corners, int levels) {
  std::vector<Cell> cells;
  if (corners == 4) {
    const int end = (1 << levels) - 1;
    for (int j = 1; j < end; ++j) {
      for (int i = 1; i < end; ++i) cells.push_back({0, i, j});
    }
    for (int i = 0; i < end; ++i) cells.push_back({0, i, 0});
    for (int j = 0; j < end; ++j) cells.push_back({0, end, j});
    for (int i = end; i > 0; --i) cells.push_back({0, i, end});
    for (int j = end; j > 0; --j) cells.push_back({0, 0, j});
    return cells;
  }
  const int end = (1 << (levels - 1)) - 1;
  for (int part = 0; part < corners; ++part) {
    for (int j = 1; j < end; ++j) {
      for (int i = 1; i <= end; ++i) cells.push_back({part, i, j});
    }
  }
  for (int part = 0; part < corners; ++part) {
    for (int i = 1; i < end; ++i) cells.push_back({(part + 1) % corners, i, end});
  }
  for (int part = 0; part < corners && end > 0; ++part) cells.push_back({part, end, end});
  for (int part = 0; part < corners; ++part) {
    for (int i = 0; i <= end; ++i) cells.push_back({part, i, 0});
    for (int j = 1; j <= end; ++j) cells.push_back({part, 0, j});
  }
  return cells;
}

/// The subdivided cage with its faces in Blender's order.
Cage inBlendersOrder(const Cage& cage, int levels) {
  Cage result = subdivided(cage, levels);
  const std::vector<FarSquare> squares = FarRefinement(cage, levels).squares;
  std::vector<std::vector<int>> faces;
  int first_part = 0, first = 0;
  for (const std::vector<int>& base : cage.faces) {
    const int corners = static_cast<int>(base.size());
    const std::vector<Cell> cells = blendersCells(corners, levels);
    for (const Cell& cell : cells) {
      for (int face = first; face < first + static_cast<int>(cells.size()); ++face) {
        const FarSquare& square = squares[face];
        if (square.face == first_part + cell.part && square.u == cell.i * square.size &&
            square.v == cell.j * square.size) {
          faces.push_back(result.faces[face]);
        }
      }
    }
    first_part += corners == 4 ? 1 : corners;
    first += static_cast<int>(cells.size());
  }
  EXPECT_EQ(faces.size(), result.faces.size());
  result.faces = faces;
  return result;
}

/// The same cage with its vertices in another order.
Cage withVerticesShuffled(Cage cage, Random& random) {
  std::vector<int> to(cage.vertexCount());
  std::iota(to.begin(), to.end(), 0);
  for (int i = cage.vertexCount() - 1; i > 0; --i) std::swap(to[i], to[random.below(i + 1)]);
  const Points positions = cage.positions;
  for (int i = 0; i < cage.vertexCount(); ++i) cage.positions.row(to[i]) = positions.row(i);
  for (std::vector<int>& face : cage.faces) {
    for (int& vertex : face) vertex = to[vertex];
  }
  for (auto& [a, b] : cage.options.edge_sharpness.edges) a = to[a], b = to[b];
  for (std::int64_t& vertex : cage.options.vertex_sharpness.vertices) vertex = to[vertex];
  return cage;
}

std::vector<Location> randomLocations(const Cage& cage, int count, Random& random) {
  std::vector<Location> at;
  const int faces = static_cast<int>(ptexFaces(cage).size());
  for (int face = 0; face < faces; ++face) {
    for (int i = 0; i < count; ++i) at.push_back({face, random.uniform(), random.uniform()});
    for (int corner = 0; corner < 4; ++corner) at.push_back(cornerLocation(face, corner));
    at.push_back({face, 0.5, random.uniform()});
    at.push_back({face, random.below(9) / 8.0, random.below(9) / 8.0});
  }
  return at;
}

/// Both meshes have the same limit surface, so a place has the same position on both.
double worstDistance(const Cage& base, const Cage& target, FaceOrder order, int levels,
                     Random& random) {
  const SubdividedFaces faces(controlMesh(base), controlMesh(target));
  EXPECT_EQ(faces.levels(), levels);
  if (levels > 1) {
    EXPECT_EQ(faces.order(), order);
  }
  const std::vector<Location> at = randomLocations(base, 4, random);
  const Points there = limitSurface(target).evaluate(faces.locate(at)).position;
  const Points here = limitSurface(base).evaluate(at).position;
  return (there - here).rowwise().norm().maxCoeff() / diagonal(base.positions);
}

void expectSameSurface(const std::string& name, const Cage& cage, int levels, Random& random) {
  SCOPED_TRACE(name + ", levels " + std::to_string(levels));
  const Cage theirs = subdivided(cage, levels);
  const Cage blenders = inBlendersOrder(cage, levels);
  EXPECT_LE(worstDistance(cage, theirs, FaceOrder::opensubdiv, levels, random), 1e-13);
  EXPECT_LE(worstDistance(cage, withVerticesShuffled(blenders, random), FaceOrder::blender, levels,
                          random),
            1e-13);
}

TEST(SubdividedFaces, TheSamePlaceIsFoundOnOpenMeshes) {
  Random random(1);
  for (int levels = 1; levels <= 4; ++levels) {
    expectSameSurface("cross", cross(), levels, random);
    expectSameSurface("holes", perturbed(gridWithHoles(6, 5, {7, 9, 17, 22}), 0.2, 2), levels,
                      random);
    expectSameSurface("pentagon", ngon(5, 3), levels, random);
    expectSameSurface("triangles", pole(5), levels, random);
  }
}

TEST(SubdividedFaces, TheSamePlaceIsFoundOnMixturesWithSharpness) {
  Random random(2);
  for (int seed = 1; seed <= 6; ++seed) {
    Cage cage = mixture(seed);
    // OpenSubdiv's Chaikin rule differs where sharpness above 1 decays.
    const bool chaikin = seed % 3 == 0;
    sharpenAtRandom(
        cage, random, 3, 5,
        chaikin ? std::vector<double>{0.3, 1, 10} : std::vector<double>{0.3, 1, 1.5, 2.75, 4, 10});
    cage.options.creasing = chaikin ? Creasing::chaikin : Creasing::uniform;
    cage.options.boundary = seed % 2 ? Boundary::smooth : Boundary::corners;
    cage.options.triangles = seed % 4 ? Triangles::catmark : Triangles::smooth;
    for (int levels : {1, 2, 3}) {
      expectSameSurface("mixture " + std::to_string(seed), cage, levels, random);
    }
  }
}

TEST(SubdividedFaces, SixLevelsOfOneFaceOfEachKind) {
  Random random(3);
  for (int corners : {3, 4, 5}) {
    Cage cage;
    cage.positions.resize(corners, 3);
    cage.faces.emplace_back();
    for (int i = 0; i < corners; ++i) {
      cage.positions.row(i) = random.vector(1);
      cage.faces[0].push_back(i);
    }
    expectSameSurface(std::to_string(corners) + " corners", cage, 6, random);
  }
}

TEST(SubdividedFaces, TheSameFacesAreZeroLevels) {
  Random random(4);
  const Cage cage = mixture(7);
  const Cage other = withVerticesShuffled(cage, random);
  EXPECT_LE(worstDistance(cage, other, FaceOrder::blender, 0, random), 1e-13);
}

TEST(SubdividedFaces, PlacesBetweenFacesAreGivenToOneOfThem) {
  const Cage cage = grid(1, 1);
  const SubdividedFaces faces(controlMesh(cage), controlMesh(subdivided(cage, 1)));
  const auto expectAt = [&](Location from, Location to) {
    const Location found = faces.locate(from);
    EXPECT_EQ(found.face, to.face);
    EXPECT_EQ(found.u, to.u);
    EXPECT_EQ(found.v, to.v);
  };
  expectAt({0, 0.5, 0.5}, {2, 0, 0});
  expectAt({0, 0.5, 0.25}, {1, 0, 0.5});
  expectAt({0, 1, 1}, {2, 1, 1});
  expectAt({0, 0, 1}, {3, 0, 1});
  expectAt({0, 0x1p-60, 0}, {0, 0x1p-59, 0});
}

/// Boundaries are sharp without a given sharpness.
Cage withoutSharpness(Cage cage) {
  cage.options = {};
  return cage;
}

/// The message about a mesh that is not a subdivision of the base.
void expectRefused(const Cage& base, const Cage& target, const std::vector<std::string>& parts) {
  std::vector<std::string> all = parts;
  all.emplace_back("structures do not match: ");
  expectThrow<MeshError>([&] { SubdividedFaces(controlMesh(base), controlMesh(target)); }, all);
}

TEST(SubdividedFaces, NumbersOfFacesThatNoSubdivisionHas) {
  expectRefused(cross(), cube(), {"the target has 6 faces; the base's 5 become 20, 80, 320"});
}

TEST(SubdividedFaces, OneFaceTurned) {
  for (int levels : {0, 1, 2, 3}) {
    const Cage base = perturbed(grid(3, 3), 0.2, 1);
    Cage target = levels == 0 ? base : inBlendersOrder(base, levels);
    std::vector<int>& face = target.faces.back();
    face = {face[1], face[2], face[3], face[0]};
    expectRefused(base, target, {"face " + std::to_string(target.faces.size() - 1)});
  }
}

TEST(SubdividedFaces, TwoFacesExchanged) {
  const Cage base = perturbed(grid(3, 3), 0.2, 1);
  for (int levels : {0, 2}) {
    Cage target = levels == 0 ? base : subdivided(base, levels);
    std::swap(target.faces[3], target.faces[5]);
    expectRefused(base, target, {levels == 0 ? "face 3" : "face ", "vertex", "corner"});
  }
}

TEST(SubdividedFaces, OtherTopologyWithAsManyFaces) {
  // A 4 x 2 sheet of quads, and a tube of as many.
  expectRefused(grid(4, 2), torus(4, 2), {"face "});
  expectRefused(torus(4, 2), grid(4, 2), {"does not share"});
  Cage cut = withoutSharpness(subdivided(cross(), 1));  // a vertex torn apart
  cut.positions.conservativeResize(cut.positions.rows() + 1, 3);
  cut.positions.row(cut.positions.rows() - 1).setZero();
  cut.faces[0][2] = cut.vertexCount() - 1;
  expectRefused(cross(), cut, {"does not share", "corner 2 of face 0"});
  Cage joined = withoutSharpness(subdivided(cross(), 1));  // two vertices that became one
  for (std::vector<int>& face : joined.faces) {
    for (int& vertex : face) vertex = vertex == 0 ? 1 : vertex;
  }
  expectRefused(cross(), joined, {"which it shares with", "should not"});
}

TEST(SubdividedFaces, FacesOfOtherSizes) {
  Cage target = withoutSharpness(subdivided(grid(2, 1), 1));
  target.faces[6].pop_back();
  expectRefused(grid(2, 1), target,
                {"face 6 of the target has 3 corners; after 1 subdivision of the base it has 4"});
  Cage other = cross();
  other.faces[2].pop_back();
  expectRefused(cross(), other, {"face 2 of the target has 3 corners; after 0 subdivisions"});
}

}  // namespace
}  // namespace limitsurf::test
