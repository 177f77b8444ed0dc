// SPDX-License-Identifier: Apache-2.0
//
// Tessellations with a level for each face, on meshes of all kinds.
#include "limitsurf/tessellate/tessellation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "limitsurf/pi.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/tessellate/tessellation_levels.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/cages/strange_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

NamedCages allCages() {
  NamedCages cages = queryCages();
  for (const auto& named : nonManifoldCages()) cages.push_back(named);
  for (int seed = 1; seed < 6; ++seed) cages.emplace_back("mixture", mixture(seed));
  return cages;
}

std::vector<int> randomLevels(const Cage& cage, int most, Random& random) {
  std::vector<int> levels;
  for (const auto& face : cage.faces) {
    levels.push_back(std::max(random.below(most + 1), face.size() == 4 ? 0 : 1));
  }
  return levels;
}

/// Calls body(polygon, corner, next corner of the polygon).
template <typename Body>
void forEachSide(const Tessellation& mesh, const Body& body) {
  std::size_t first = 0;
  for (std::size_t polygon = 0; polygon < mesh.face_sizes.size(); ++polygon) {
    const std::size_t size = static_cast<std::size_t>(mesh.face_sizes[polygon]);
    for (std::size_t k = 0; k < size; ++k) body(polygon, first + k, first + (k + 1) % size);
    first += size;
  }
}

TEST(TessellationLevels, PolygonsMeetAlongWholeSidesAndCoverTheFaces) {
  Random random(1);
  int graded = 0;
  for (const auto& [name, cage] : allCages()) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const std::vector<int> levels = randomLevels(cage, 4, random);
    const Tessellation mesh = tessellate(surface, levels);
    ASSERT_EQ(mesh.corners.size(), mesh.face_vertices.size());

    using Edge = std::pair<int, int>;
    std::map<Edge, int> uses, cage_uses, cage_levels;
    std::vector<long> twice_area(surface.faceCount(), 0);
    forEachSide(mesh, [&](std::size_t polygon, std::size_t from, std::size_t to) {
      const Edge side = std::minmax(mesh.face_vertices[from], mesh.face_vertices[to]);
      EXPECT_NE(side.first, side.second);
      ++uses[side];
      const auto [a, b] = std::pair(mesh.corners[from], mesh.corners[to]);
      twice_area[mesh.ptex_face[polygon]] += long(a.u) * b.v - long(b.u) * a.v;
    });
    for (int face = 0; face < static_cast<int>(cage.faces.size()); ++face) {
      if (surface.refused().count(face)) continue;
      const std::vector<int>& vertices = cage.faces[face];
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Edge edge = std::minmax(vertices[k], vertices[(k + 1) % vertices.size()]);
        ++cage_uses[edge];
        cage_levels[edge] = std::max(cage_levels[edge], levels[face]);
      }
    }
    std::map<int, long> counted, expected;
    for (const auto& [edge, count] : uses) ++counted[count];
    for (const auto& [edge, count] : cage_uses) expected[count] += 1l << cage_levels[edge];
    counted.erase(2);  // most of these lie within faces
    expected.erase(2);
    EXPECT_EQ(counted, expected);

    constexpr long kWhole = 2l * Tessellation::Corner::kSteps * Tessellation::Corner::kSteps;
    for (int face = 0; face < surface.faceCount(); ++face) {
      EXPECT_EQ(twice_area[face], surface.refused().count(surface.baseFace()[face]) ? 0 : kWhole);
    }
    graded += std::count(mesh.face_sizes.begin(), mesh.face_sizes.end(), 3) > 0;
  }
  EXPECT_GT(graded, 20);
}

TEST(TessellationLevels, CornersLieWhereTheirPointsDo) {
  Random random(2);
  for (const auto& [name, cage] : allCages()) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const Tessellation mesh = tessellate(surface, randomLevels(cage, 3, random));
    std::vector<Location> at;
    std::vector<bool> is_named(mesh.locations.size(), false);
    forEachSide(mesh, [&](std::size_t polygon, std::size_t corner, std::size_t) {
      at.push_back(mesh.cornerLocation(polygon, corner));
      is_named[mesh.face_vertices[corner]] = true;
    });
    EXPECT_EQ(std::count(is_named.begin(), is_named.end(), false), 0);
    const Points positions = surface.evaluate(at).position;
    const double size = diagonal(cage.positions);
    for (std::size_t corner = 0; corner < at.size(); ++corner) {
      const auto row = static_cast<Eigen::Index>(corner);
      EXPECT_LE((positions.row(row) - mesh.positions.row(mesh.face_vertices[corner])).norm(),
                4 * kPositionError * size)
          << describe(at[corner]);
    }
  }
}

TEST(TessellationLevels, ThreadsAndEqualLevelsChangeNothing) {
  const Cage cage = mixture(3);
  const LimitSurface surface = limitSurface(cage);
  const std::vector<int> equal(cage.faces.size(), 3);
  const Tessellation one = tessellate(surface, 3, {1}), all = tessellate(surface, equal);
  EXPECT_EQ(one.face_vertices, all.face_vertices);
  EXPECT_EQ(one.positions, all.positions);
  EXPECT_EQ(one.normals, all.normals);
}

/// The largest distance of sampled places on the polygons from the surface.
double farthest(const SurfaceSearch& search, const Tessellation& mesh, Random& random) {
  Points places(4 * mesh.face_sizes.size(), 3);
  std::size_t corner = 0;
  Eigen::Index row = 0;
  for (const int size : mesh.face_sizes) {
    const auto point = [&](int k) -> Vector3 {
      return mesh.positions.row(mesh.face_vertices[corner + k]);
    };
    for (int k = 0; k < 4; ++k) {
      const int second = size == 4 ? 1 + k % 2 : 1;
      double a = random.uniform(), b = random.uniform();
      if (a + b > 1) a = 1 - a, b = 1 - b;
      places.row(row++) = (1 - a - b) * point(0) + a * point(second) + b * point(second + 1);
    }
    corner += size;
  }
  return search.closest(places).distance.maxCoeff();
}

TEST(LevelsWithin, PolygonsAreAsCloseAsAskedAndNoCloserThanNeeded) {
  Random random(4);
  for (const auto& [cage, tolerance] :
       {std::pair(cross(), 1e-2), std::pair(cross(), 1e-3), std::pair(cube(), 1e-3),
        std::pair(prism(5, true), 1e-2), std::pair(mixture(2), 5e-3), std::pair(torus(7, 5), 5e-3),
        std::pair(fan(9, false, 1), 2e-3)}) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    LevelOptions options;
    options.most = 10;
    const FaceLevels found = levelsWithin(surface, tolerance, options);
    EXPECT_LE(found.measure.maxCoeff(), tolerance);
    EXPECT_LE(farthest(search, tessellate(surface, found.levels), random), tolerance);
    // One level less is not enough anywhere.
    std::vector<int> fewer = found.levels;
    for (std::size_t face = 0; face < fewer.size(); ++face) {
      fewer[face] = std::max(fewer[face] - 1, cage.faces[face].size() == 4 ? 0 : 1);
    }
    EXPECT_GT(farthest(search, tessellate(surface, fewer), random), tolerance);
    options.threads = 1;
    EXPECT_EQ(levelsWithin(surface, tolerance, options).levels, found.levels);
  }
}

TEST(LevelsWithin, OutlinesCountOnPlanes) {
  // The surface is flat, but its boundary is a curve.
  const LimitSurface surface = limitSurface(grid(3, 3));
  const FaceLevels found = levelsWithin(surface, 1e-3);
  EXPECT_GE(found.levels[0], 3);  // a corner
  EXPECT_LE(found.levels[4], found.levels[0] - 1);
}

TEST(LevelsWithin, NeighboursDifferByTwoAtMost) {
  // A spike in one corner of a large plane.
  Cage cage = grid(12, 2);
  cage.positions(0, 2) = 3;
  const LimitSurface surface = limitSurface(cage);
  const FaceLevels found = levelsWithin(surface, 1e-4);
  for (int column = 0; column + 1 < 12; ++column) {
    EXPECT_LE(std::abs(found.levels[column] - found.levels[column + 1]), kLargestLevelStep);
  }
  EXPECT_GE(*std::max_element(found.levels.begin(), found.levels.end()), 5);
}

TEST(LevelsWithin, TellsWhatTheMostLevelsDoNotReach) {
  LevelOptions options;
  options.most = 2;
  const FaceLevels found = levelsWithin(limitSurface(cube()), 1e-4, options);
  EXPECT_EQ(found.levels, std::vector<int>(6, 2));
  EXPECT_GT(found.measure.minCoeff(), 1e-4);
}

TEST(LevelsOfLength, UnitSquaresNeedTheLogarithm) {
  // The inner face of a grid's limit is the unit square itself.
  const LimitSurface surface = limitSurface(grid(5, 5));
  EXPECT_EQ(levelsOfLength(surface, 0.26).levels[12], 2);
  EXPECT_EQ(levelsOfLength(surface, 0.24).levels[12], 3);
  EXPECT_NEAR(levelsOfLength(surface, 0.24).measure[12], 0.125, 1e-12);

  PictureView view;
  view.matrix = Eigen::Matrix4d::Identity();
  view.matrix.topLeftCorner<2, 2>() *= 100;
  EXPECT_EQ(levelsOfLength(surface, 26, &view).levels[12], 2);
  view.matrix.row(3) << 0, 0, 0, 2;
  EXPECT_EQ(levelsOfLength(surface, 26, &view).levels[12], 1);
}

TEST(LevelsOfLength, WhatIsBehindHasNoLength) {
  // The view is along x from x = 2.5; w is the depth.
  const LimitSurface surface = limitSurface(grid(12, 1));
  PictureView view;
  view.matrix << 0, 100, 0, 0, 0, 0, 100, 0, 0, 0, 1, 0, 1, 0, 0, -2.5;
  view.nearest = 0.1;
  const FaceLevels found = levelsOfLength(surface, 10, &view);
  EXPECT_EQ(found.measure[0], 0);
  EXPECT_EQ(found.measure[1], 0);
  // The line at y = 1 from the nearest depth, 0.1, to 2.625 is 1000 - 800 long, an eighth of a
  // side.
  EXPECT_EQ(found.levels[2], 8);
  EXPECT_EQ(found.levels[1], 8 - kLargestLevelStep);  // for its neighbour's sake
  EXPECT_EQ(found.levels[11], 1);                     // 100 / 8.5 at most
}

TEST(LevelsOfLength, RefusesWhatMeansNothing) {
  const LimitSurface surface = limitSurface(cube());
  LevelOptions options;
  for (const double size : {0., -1., std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(levelsWithin(surface, size), std::invalid_argument);
    EXPECT_THROW(levelsOfLength(surface, size), std::invalid_argument);
  }
  for (const int most : {0, 13}) {
    options.most = most;
    EXPECT_THROW(levelsWithin(surface, 1, options), std::invalid_argument);
  }
  EXPECT_THROW(tessellate(surface, std::vector<int>{1, 2}), std::invalid_argument);
  EXPECT_THROW(tessellate(surface, std::vector<int>{1, 2, 3, 4, 5, 13}), std::invalid_argument);
}

/// The longest side of the quads of a face whose squares have `quads` quads a side, in space or in
/// a picture, measured along the surface in steps of 1/64.
double longestSide(const LimitSurface& surface, const std::vector<int>& squares, int quads,
                   const PictureView* view) {
  constexpr int kSteps = 64;
  const auto seen = [&](const Location& at) -> Vector3 {
    const Vector3 there = surface.evaluate(std::vector<Location>{at}).position.row(0);
    if (!view) return there;
    const Eigen::Vector4d h = view->matrix * there.homogeneous();
    return {h.x() / h.w(), h.y() / h.w(), 0};
  };
  double longest = 0;
  for (const int square : squares) {
    for (int line = 0; line <= quads; ++line) {
      for (const bool across : {false, true}) {
        const auto at = [&](int step) {
          const double x = double(step) / kSteps, y = double(line) / quads;
          return seen(across ? Location{square, y, x} : Location{square, x, y});
        };
        for (int quad = 0; quad < quads; ++quad) {
          double side = 0;
          for (int k = 0; k < kSteps / quads; ++k) {
            const int step = quad * kSteps / quads + k;
            side += (at(step + 1) - at(step)).norm();
          }
          longest = std::max(longest, side);
        }
      }
    }
  }
  return longest;
}

TEST(LevelsOfLength, AreTheLowest) {
  PictureView camera;  // close to the mesh, along z
  camera.matrix = Eigen::Matrix4d::Identity();
  camera.matrix.row(3) << 0, 0, -1, 1.5;
  double largest = 0;
  for (const Cage& cage : {perturbed(inTriangles(grid(3, 3)), 0.35, 1), perturbed(cube(), 0.3, 2),
                           perturbed(grid(4, 4), 0.4, 3), mixture(2)}) {
    const LimitSurface surface = limitSurface(cage);
    std::vector<std::vector<int>> squares(cage.faces.size());
    for (int i = 0; i < surface.faceCount(); ++i) squares[surface.baseFace()[i]].push_back(i);
    for (const bool in_picture : {false, true}) {
      const PictureView* view = in_picture ? &camera : nullptr;
      for (const double length : {0.6, 0.25}) {
        const FaceLevels found = levelsOfLength(surface, length, view);
        for (std::size_t face = 0; face < cage.faces.size(); ++face) {
          const bool is_quad = cage.faces[face].size() == 4;
          // the first level at which the sides fit; eighths leave some percent in doubt
          int level = is_quad ? 0 : 1;
          double longest;
          const auto quads = [&] { return 1 << (is_quad ? level : level - 1); };
          while ((longest = longestSide(surface, squares[face], quads(), view)) > 1.05 * length &&
                 quads() < 8) {
            ++level;
          }
          if (longest > length / 1.05) continue;
          EXPECT_NEAR(found.measure[face] / longest, 1, 0.05) << "face " << face;
          largest = std::max(largest, std::abs(found.measure[face] / longest - 1));
        }
      }
    }
  }
  EXPECT_GT(largest, 1e-6);  // places between the eighths were compared
}

/// Beside an irregular vertex of high valence the sides of quads shrink less from level to level
/// than elsewhere.
TEST(LevelsOfLength, HoldBesideIrregularVertices) {
  for (const int valence : {3, 5, 13}) {
    Cage cage;
    cage.positions.setZero(2 * valence + 1, 3);
    for (int i = 0; i < valence; ++i) {
      const double angle = 2 * kPi<double> * i / valence, half = kPi<double> / valence;
      cage.positions.row(1 + i) << std::cos(angle), std::sin(angle), 0;
      cage.positions.row(1 + valence + i) << 1.5 * std::cos(angle + half),
          1.5 * std::sin(angle + half), 0;
      cage.faces.push_back({0, 1 + i, 1 + valence + i, 1 + (i + 1) % valence});
    }
    const LimitSurface surface = limitSurface(cage);
    for (const double length : {0.1, 0.03}) {
      LevelOptions options;
      options.most = 10;
      const FaceLevels found = levelsOfLength(surface, length, nullptr, options);
      const Tessellation made = tessellate(surface, found.levels);
      double longest = 0;
      std::size_t first = 0;
      for (const int size : made.face_sizes) {
        for (int k = 0; k < size; ++k) {
          const int a = made.face_vertices[first + k],
                    b = made.face_vertices[first + (k + 1) % size];
          longest = std::max(longest, (made.positions.row(a) - made.positions.row(b)).norm());
        }
        first += size;
      }
      EXPECT_LE(longest, length) << "valence " << valence;
      EXPECT_GE(found.measure.maxCoeff(), longest * (1 - 1e-12)) << "valence " << valence;
    }
  }
}

TEST(LevelsOfLength, RefusedFacesHaveNone) {
  Cage cage = grid(3, 3);
  cage.options.holes = {4};
  const FaceLevels found = levelsOfLength(limitSurface(cage), 0.3);
  EXPECT_EQ(found.levels[4], 0);
  EXPECT_TRUE(std::isnan(found.measure[4]));
  EXPECT_GE(found.levels[0], 1);
}

}  // namespace
}  // namespace limitsurf::test
