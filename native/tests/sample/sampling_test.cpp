// SPDX-License-Identifier: Apache-2.0
//
// Locations and polygons that cover the whole surface: vertices, scattering, tessellation, area and
// bounds.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/jittered_sampling.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/meshes.h"
#include "support/throws.h"
#include "support/truth/corner_points.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

TEST(VertexLocations, NameEveryVertexOnce) {
  for (const Cage& cage : {cross(), cube(), mixture(3), ngon(7, 1)}) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> locations = surface.vertexLocations();
    const CornerPoints corners(cage);
    ASSERT_EQ(static_cast<int>(locations.size()), cage.vertexCount());
    for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
      const CornerPoint* corner = corners.at(locations[vertex]);
      ASSERT_NE(corner, nullptr) << describe(locations[vertex]);
      EXPECT_EQ(corner->vertex, vertex);
    }
  }
}

TEST(ScatterJittered, StratifiesEveryFace) {
  const Cage cage = mixture(3);
  const LimitSurface surface = limitSurface(cage);
  const int side = 5;
  const std::vector<Location> at = scatterJittered(surface, side, 7);
  ASSERT_EQ(static_cast<int>(at.size()), surface.faceCount() * side * side);
  std::set<std::array<int, 3>> cells;
  int last = 0;
  for (const Location& location : at) {
    EXPECT_GE(location.face, last);
    last = location.face;
    ASSERT_TRUE(location.u >= 0 && location.u <= 1 && location.v >= 0 && location.v <= 1);
    cells.insert(
        {location.face, static_cast<int>(location.u * side), static_cast<int>(location.v * side)});
  }
  EXPECT_EQ(cells.size(), at.size());
}

TEST(ScatterJittered, DependsOnTheSeedAlone) {
  const LimitSurface surface = limitSurface(mixture(3));
  const auto same = [](const std::vector<Location>& a, const std::vector<Location>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](auto& x, auto& y) {
             return x.face == y.face && x.u == y.u && x.v == y.v;
           });
  };
  const std::vector<Location> one = scatterJittered(surface, 20, 7, 1);
  EXPECT_TRUE(same(one, scatterJittered(surface, 20, 7, 0)));
  EXPECT_TRUE(same(one, scatterJittered(surface, 20, 7, 3)));
  EXPECT_FALSE(same(one, scatterJittered(surface, 20, 8)));
}

TEST(ScatterJittered, IsTheSameOnSomeFaces) {
  Cage cage = mixture(3);
  cage.options.holes = {2};
  const LimitSurface surface = limitSurface(cage);
  std::vector<std::int64_t> faces = {7, 1, 1};
  int refused = 0;
  while (surface.baseFace()[refused] != 2) ++refused;
  faces.push_back(refused);
  const std::vector<Location> all = scatterJittered(surface, 3, 5),
                              some = scatterJittered(surface, faces, 3, 5);
  ASSERT_EQ(some.size(), 27u);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const std::int64_t face = faces[i / 9];
    const auto first =
        std::find_if(all.begin(), all.end(), [&](auto& l) { return l.face == face; });
    const Location& same = first[static_cast<std::ptrdiff_t>(i % 9)];
    EXPECT_TRUE(some[i].face == face && some[i].u == same.u && some[i].v == same.v);
  }
  faces.push_back(surface.faceCount());
  expectThrow<LocationError>([&] { scatterJittered(surface, faces, 3, 5); }, {"faces[4]"});
}

TEST(ScatterJittered, IsUniformWithinItsCells) {
  const LimitSurface surface = limitSurface(grid(10, 10));
  const int side = 10, bins = 10;
  std::vector<double> count_u(bins, 0), count_v(bins, 0);
  double mixed = 0;
  const std::vector<Location> at = scatterJittered(surface, side, 3);
  for (const Location& location : at) {
    const double u = location.u * side - std::floor(location.u * side);
    const double v = location.v * side - std::floor(location.v * side);
    ++count_u[static_cast<int>(u * bins)];
    ++count_v[static_cast<int>(v * bins)];
    mixed += (u - 0.5) * (v - 0.5);
  }
  const double expected = static_cast<double>(at.size()) / bins;
  double chi_u = 0, chi_v = 0;
  for (int i = 0; i < bins; ++i) {
    chi_u += std::pow(count_u[i] - expected, 2) / expected;
    chi_v += std::pow(count_v[i] - expected, 2) / expected;
  }
  EXPECT_LT(chi_u, 30);  // nine degrees of freedom: one in 2000
  EXPECT_LT(chi_v, 30);
  EXPECT_LT(std::abs(mixed) * 12 / std::sqrt(static_cast<double>(at.size())), 4);
}

/// The sum of the areas of quads, each taken as two triangles.
double polygonArea(const Tessellation& mesh) {
  double sum = 0;
  for (std::size_t q = 0; q < mesh.face_vertices.size(); q += 4) {
    Vector3 p[4];
    for (int i = 0; i < 4; ++i) p[i] = mesh.positions.row(mesh.face_vertices[q + i]);
    sum += ((p[1] - p[0]).cross(p[2] - p[0]).norm() + (p[2] - p[0]).cross(p[3] - p[0]).norm()) / 2;
  }
  return sum;
}

TEST(Tessellate, IsWatertight) {
  for (const auto& [cage, closed] :
       {std::pair(cross(), false), std::pair(cube(), true), std::pair(tetrahedron(), true),
        std::pair(prism(5, true), true), std::pair(mixture(2), false)}) {
    const LimitSurface surface = limitSurface(cage);
    const int levels = 3;
    const Tessellation mesh = tessellate(surface, levels);
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t q = 0; q < mesh.face_vertices.size(); q += 4) {
      for (int i = 0; i < 4; ++i) {
        const int a = mesh.face_vertices[q + i], b = mesh.face_vertices[q + (i + 1) % 4];
        ASSERT_TRUE(a >= 0 && a < mesh.positions.rows() && a != b);
        EXPECT_EQ(++edges[std::make_pair(a, b)], 1) << "two quads of opposite winding";
      }
    }
    int boundary = 0, cage_boundary = 0;
    for (const auto& [edge, count] : edges) boundary += edges.count({edge.second, edge.first}) == 0;
    std::set<std::pair<int, int>> cage_edges;
    for (const std::vector<int>& face : cage.faces) {
      for (std::size_t i = 0; i < face.size(); ++i) {
        cage_edges.emplace(face[i], face[(i + 1) % face.size()]);
      }
    }
    for (const auto& [a, b] : cage_edges) cage_boundary += cage_edges.count({b, a}) == 0;
    EXPECT_EQ(boundary, cage_boundary << levels);
    EXPECT_EQ(closed, boundary == 0);
    // The Euler characteristic is that of the cage.
    const long tessellated = mesh.positions.rows() -
                             (static_cast<long>(edges.size()) + boundary) / 2 +
                             static_cast<long>(mesh.face_vertices.size()) / 4;
    const long original = cage.vertexCount() -
                          (static_cast<long>(cage_edges.size()) + cage_boundary) / 2 +
                          static_cast<long>(cage.faces.size());
    EXPECT_EQ(tessellated, original);
  }
}

TEST(Tessellate, LiesOnTheSurface) {
  const Cage cage = mixture(2);
  const LimitSurface surface = limitSurface(cage);
  const Tessellation mesh = tessellate(surface, 2);
  ASSERT_EQ(static_cast<int>(mesh.locations.size()), mesh.positions.rows());
  ASSERT_EQ(mesh.normals.rows(), mesh.positions.rows());
  const Evaluation e = surface.evaluate(mesh.locations, Derivatives::first, true);
  EXPECT_LE((e.position - mesh.positions).cwiseAbs().maxCoeff(),
            kPositionError * diagonal(cage.positions));
  for (int i = 0; i < mesh.normals.rows(); ++i) {
    EXPECT_NEAR(mesh.normals.row(i).norm(), 1, 1e-12) << describe(mesh.locations[i]);
    if (e.normal.row(i).hasNaN()) continue;
    EXPECT_LE((e.normal.row(i) - mesh.normals.row(i)).norm(), 1e-11) << describe(mesh.locations[i]);
  }
  // The quads have the orientation of the normals.
  int turned = 0;
  for (std::size_t q = 0; q < mesh.face_vertices.size(); q += 4) {
    const auto p = [&](int i) -> Vector3 { return mesh.positions.row(mesh.face_vertices[q + i]); };
    const Vector3 normal = mesh.normals.row(mesh.face_vertices[q]);
    turned += (p(2) - p(0)).cross(p(3) - p(1)).dot(normal) < 0;
  }
  EXPECT_LE(turned, static_cast<int>(mesh.face_vertices.size()) / 100);
}

TEST(Tessellate, RefusesSillyLevels) {
  const LimitSurface surface = limitSurface(cube());
  EXPECT_THROW(tessellate(surface, -1), std::invalid_argument);
  EXPECT_EQ(tessellate(surface, 0).face_vertices.size(), 4u * 6);
  EXPECT_THROW(tessellate(limitSurface(tetrahedron()), 0), std::invalid_argument);
}

TEST(Area, IsThatOfFineTessellations) {
  for (const Cage& cage : {cross(), cube(), prism(5, true)}) {
    const LimitSurface surface = limitSurface(cage);
    // The error of the polygons' area falls by a factor of 4 with each level, so it is extrapolated
    // twice.
    const double a4 = polygonArea(tessellate(surface, 4)), a5 = polygonArea(tessellate(surface, 5)),
                 a6 = polygonArea(tessellate(surface, 6));
    const double b5 = a5 + (a5 - a4) / 3, b6 = a6 + (a6 - a5) / 3;
    EXPECT_NEAR(surfaceArea(surface), b6, 10 * std::abs(b6 - b5) + 1e-8 * b6);
    EXPECT_EQ(surfaceArea(surface, 1), surfaceArea(surface, 0));
  }
}

TEST(Area, IsExactOnPlanes) {
  // Boundary curves of a straight-sided grid with pinned corners are its sides.
  Cage cage = grid(3, 2);
  cage.options.boundary = Boundary::corners;
  EXPECT_NEAR(surfaceArea(limitSurface(cage)), 6, 6 * kAreaError);
}

TEST(Bounds, AreTight) {
  for (const Cage& cage : {cross(), cube(), torus(7, 5), mixture(5), fan(9, false, 1)}) {
    const LimitSurface surface = limitSurface(cage);
    const auto bounds = surface.bounds();
    const Points fine = tessellate(surface, 6).positions;
    const double size = diagonal(cage.positions);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = fine.col(axis).minCoeff(), high = fine.col(axis).maxCoeff();
      EXPECT_LE(bounds(0, axis), low + kPositionError * size);
      EXPECT_GE(bounds(1, axis), high - kPositionError * size);
      // A fine grid misses an extremum by about the square of its spacing.
      EXPECT_GE(bounds(0, axis), low - 1e-3 * size);
      EXPECT_LE(bounds(1, axis), high + 1e-3 * size);
    }
  }
}

TEST(Bounds, AreExactWhereTheExtremumIsKnown) {
  // By symmetry the cube's limit surface is extremal at the middle of its faces.
  const LimitSurface surface = limitSurface(cube());
  const std::vector<Location> middle = {{0, 0.5, 0.5}, {1, 0.5, 0.5}};
  const Points z = surface.evaluate(middle).position;
  const auto bounds = surface.bounds();
  EXPECT_NEAR(bounds(0, 2), z(0, 2), 1e-13);
  EXPECT_NEAR(bounds(1, 2), z(1, 2), 1e-13);
}

}  // namespace
}  // namespace limitsurf::test
