// SPDX-License-Identifier: Apache-2.0
//
// Properties of sharpness that need no truth to compare with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// Every quantity of both surfaces has the same bits at the same locations; NaN equals NaN.
void expectSame(const std::string& name, const Cage& a, const Cage& b) {
  Random random(1);
  const std::vector<Location> at = everywhere(a, {2, 12, 40}, 3, random);
  const Evaluation x = limitSurface(a).evaluate(at, Derivatives::second, true);
  const Evaluation y = limitSurface(b).evaluate(at, Derivatives::second, true);
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    const Truth left = rowOf(x, i), right = rowOf(y, i);
    for (int q = 0; q < kQuantities; ++q) {
      for (int axis = 0; axis < 3; ++axis) {
        const double l = left[q][axis], r = right[q][axis];
        ASSERT_TRUE(l == r || (std::isnan(l) && std::isnan(r)))
            << name << ", " << describe(at[i]) << ": " << kQuantityNames[q] << " is " << l
            << " and " << r;
      }
    }
  }
}

Cage someCage() { return mixture(31); }

/// The cage with sharpness given by the number of the edge and of the vertex.
template <typename EdgeValue, typename VertexValue>
Cage sharpened(Cage cage, const EdgeValue& edge_value, const VertexValue& vertex_value) {
  int number = 0;
  for (const auto& [a, b] : edgesOf(cage)) sharpenEdge(cage, a, b, edge_value(number++));
  for (int v = 0; v < cage.vertexCount(); ++v) sharpenVertex(cage, v, vertex_value(v));
  return cage;
}

/// Every third edge and every fifth vertex is sharp.
Cage sharpened(const Cage& cage, double value) {
  return sharpened(
      cage, [&](int edge) { return edge % 3 == 0 ? value : 0; },
      [&](int vertex) { return vertex % 5 == 0 ? value : 0; });
}

TEST(Sharpness, OfZeroIsNone) {
  for (Boundary boundary : {Boundary::smooth, Boundary::corners}) {
    Cage cage = someCage();
    cage.options.boundary = boundary;
    Cage zeros = sharpened(cage, 0);
    expectSame("zeros", cage, zeros);
    zeros.options.creasing = Creasing::chaikin;
    expectSame("zeros, chaikin", cage, zeros);
  }
}

TEST(Sharpness, OfTenAndMoreIsInfinite) {
  for (Creasing creasing : {Creasing::uniform, Creasing::chaikin}) {
    Cage cage = someCage();
    cage.options.creasing = creasing;
    const Cage infinite = sharpened(cage, std::numeric_limits<double>::infinity());
    for (double value : {10.0, 10.5, 12.0, 1e6, 1e300, std::numeric_limits<double>::max()}) {
      expectSame(std::to_string(value), infinite, sharpened(cage, value));
    }
    // This value rounds to 10 in float32.
    expectSame("just below 10", infinite, sharpened(cage, 9.9999999));
  }
}

TEST(Sharpness, IsRoundedToFloat32) {
  for (double value : {0.1, 0.7, 1.3, 5.2}) {
    expectSame(std::to_string(value), sharpened(someCage(), value),
               sharpened(someCage(), static_cast<double>(static_cast<float>(value))));
  }
  expectSame("too small for float32", someCage(), sharpened(someCage(), 1e-60));
}

TEST(Sharpness, OfBoundaryEdgesIsInfiniteAnyway) {
  const Cage cage = perturbed(gridWithHoles(5, 4, {6}), 0.2, 1);
  Cage sharp = cage;
  std::map<std::pair<int, int>, int> faces_at;
  for (const std::vector<int>& face : cage.faces) {
    for (int i = 0; i < 4; ++i) ++faces_at[std::minmax(face[i], face[(i + 1) % 4])];
  }
  double value = 0.1;
  for (const auto& [edge, faces] : faces_at) {
    if (faces == 1) sharpenEdge(sharp, edge.first, edge.second, value += 0.4);
  }
  for (Creasing creasing : {Creasing::uniform, Creasing::chaikin}) {
    sharp.options.creasing = creasing;
    expectSame("boundary", cage, sharp);
  }
}

TEST(Sharpness, OfEdgesDoesNotDependOnTheirDirectionOrOrder) {
  Random random(2);
  Cage cage = someCage();
  sharpenAtRandom(cage, random, 2, 4, {0.5, 1.25, 3, 10});
  Cage other = cage;
  EdgeSharpness& edges = other.options.edge_sharpness;
  for (auto& [a, b] : edges.edges) std::swap(a, b);
  std::reverse(edges.edges.begin(), edges.edges.end());
  std::reverse(edges.values.begin(), edges.values.end());
  VertexSharpness& vertices = other.options.vertex_sharpness;
  std::reverse(vertices.vertices.begin(), vertices.vertices.end());
  std::reverse(vertices.values.begin(), vertices.values.end());
  expectSame("other order", cage, other);
}

TEST(Sharpness, OfLonelyCornersIsThatOfTheCornersRule) {
  Cage smooth = perturbed(gridWithHoles(4, 4, {5}), 0.2, 1), corners = smooth;
  corners.options.boundary = Boundary::corners;
  std::vector<int> faces_at(smooth.vertexCount(), 0);
  for (const std::vector<int>& face : smooth.faces) {
    for (int vertex : face) ++faces_at[vertex];
  }
  for (int v = 0; v < smooth.vertexCount(); ++v) {
    if (faces_at[v] == 1) sharpenVertex(smooth, v, 10);
  }
  expectSame("corners", smooth, corners);
}

TEST(Sharpness, OfEverythingLeavesBilinearQuads) {
  Random random(3);
  for (const Cage& plain : {perturbed(cube(), 0.3, 1), perturbed(torus(5, 4), 0.3, 2),
                            perturbed(gridWithHoles(4, 4, {5, 6}), 0.3, 3)}) {
    const Cage cage = sharpened(plain, [](int) { return INFINITY; }, [](int) { return INFINITY; });
    Cage bilinear = plain;
    bilinear.options.scheme = Scheme::bilinear;
    const std::vector<Location> at = everywhere(cage, {1, 20, 40}, 3, random);
    const Evaluation a = limitSurface(cage).evaluate(at, Derivatives::second, true);
    const Evaluation b = limitSurface(bilinear).evaluate(at, Derivatives::second, true);
    Accuracy accuracy("all sharp", diagonal(cage.positions));
    for (int i = 0; i < static_cast<int>(at.size()); ++i) accuracy.addScale(at[i], rowOf(b, i));
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      accuracy.check(at[i], rowOf(a, i), rowOf(b, i));
    }
  }
}

TEST(Sharpness, CreasesAreCurvesOfTheirOwn) {
  // A crease curve depends on its own vertices alone.
  Cage cage = perturbed(grid(5, 4), 0.2, 1);
  const auto vertex = [&](int i, int j) {
    int found;
    (cage.positions.rowwise() - Eigen::RowVector3d(i, j, 0)).rowwise().norm().minCoeff(&found);
    return found;
  };
  std::vector<int> run;
  for (int i = 0; i <= 5; ++i) run.push_back(vertex(i, 2));
  for (int i = 0; i < 5; ++i) sharpenEdge(cage, run[i], run[i + 1], 10);
  Random random(6);
  Cage moved = cage;
  for (int v = 0; v < cage.vertexCount(); ++v) {
    if (std::count(run.begin(), run.end(), v) == 0) moved.positions.row(v) += random.vector(1);
  }
  const LimitSurface a = limitSurface(cage), b = limitSurface(moved);
  const double size = diagonal(cage.positions) + diagonal(moved.positions);
  int compared = 0;
  for (int face = 0; face < static_cast<int>(cage.faces.size()); ++face) {
    for (int side = 0; side < 4; ++side) {
      const int from = cage.faces[face][side], to = cage.faces[face][(side + 1) % 4];
      const auto on_run = [&](int v) { return std::count(run.begin(), run.end(), v) != 0; };
      if (!on_run(from) || !on_run(to)) continue;
      const Location p = cornerLocation(face, side), q = cornerLocation(face, (side + 1) % 4);
      std::vector<Location> at;
      for (double t : {0.0, 1e-9, 0.3, 0.5, 1.0}) {
        at.push_back({face, p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)});
      }
      const Points x = a.evaluate(at).position, y = b.evaluate(at).position;
      EXPECT_LE((x - y).rowwise().norm().maxCoeff(), kPositionError * size) << "face " << face;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 10);
}

TEST(Sharpness, BothFacesOfASharpEdgeMeet) {
  Random random(7);
  for (int seed = 1; seed <= 6; ++seed) {
    Cage cage =
        seed % 2 == 0 ? perturbed(torus(6, 5), 0.2, seed) : perturbed(grid(5, 5), 0.2, seed);
    cage.options.creasing = seed % 3 == 0 ? Creasing::chaikin : Creasing::uniform;
    sharpenAtRandom(cage, random, 2, 4, {0.3, 1, 2.7, 9.9, 10});
    const LimitSurface surface = limitSurface(cage);
    std::map<std::pair<int, int>, std::pair<int, int>> side_of;
    for (int face = 0; face < static_cast<int>(cage.faces.size()); ++face) {
      for (int side = 0; side < 4; ++side) {
        side_of[{cage.faces[face][side], cage.faces[face][(side + 1) % 4]}] = {face, side};
      }
    }
    const auto along = [](const std::pair<int, int>& side, double t) {
      const Location p = cornerLocation(side.first, side.second),
                     q = cornerLocation(side.first, (side.second + 1) % 4);
      return Location{side.first, (1 - t) * p.u + t * q.u, (1 - t) * p.v + t * q.v};
    };
    for (const auto& [edge, left] : side_of) {
      const auto right = side_of.find({edge.second, edge.first});
      if (right == side_of.end()) continue;
      std::vector<Location> mine, other;
      for (double t : {0.0, 0x1p-40, 0x1p-12, 0.25, 0.625, 1 - 0x1p-20, 1.0}) {
        mine.push_back(along(left, t));
        other.push_back(along(right->second, 1 - t));
      }
      const Points x = surface.evaluate(mine).position, y = surface.evaluate(other).position;
      EXPECT_LE((x - y).rowwise().norm().maxCoeff(), kPositionError * diagonal(cage.positions))
          << "seed " << seed << ", edge (" << edge.first << ", " << edge.second << ")";
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
