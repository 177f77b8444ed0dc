// SPDX-License-Identifier: Apache-2.0
//
// Everything that a surface offers besides evaluation, on sharp and non-manifold cages.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "limitsurf/sample/area.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/meshes.h"
#include "support/cages/sharp_meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/truth/corner_points.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

NamedCages sharpCages() {
  NamedCages cages = {{"cube", perturbed(cube(), 0.2, 1)},
                      {"torus", perturbed(torus(6, 5), 0.2, 2)},
                      {"grid", perturbed(gridWithHoles(4, 4, {5}), 0.2, 3)},
                      {"mixture", mixture(41)},
                      {"another mixture", mixture(42)},
                      {"dart", fan(6, true, 4)},
                      {"cone", fan(5, true, 5)}};
  sharpenEdge(cages[5].second, cages[5].second.faces[0][0], cages[5].second.faces[0][1], 10);
  sharpenVertex(cages[6].second, cages[6].second.faces[0][0], 10);
  Random random(1);
  for (int i = 0; i < 5; ++i) {
    Cage& cage = cages[i].second;
    if (i % 2 == 1) cage.options.creasing = Creasing::chaikin;
    sharpenAtRandom(cage, random, 3, 5, {0.5, 1, 2.75, 4, 10});
  }
  return cages;
}

NamedCages allCages() {
  NamedCages cages = sharpCages();
  const NamedCages strange = nonManifoldCages();
  cages.insert(cages.end(), strange.begin(), strange.end());
  return cages;
}

TEST(SharpSurfaces, StencilsReproduceEvaluation) {
  Random random(2);
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    const std::vector<Location> at = hereAndThere(cage, {2, 9, 30}, 1, random);
    const Evaluation e = surface.evaluate(at, Derivatives::first);
    const Stencils stencils = surface.stencils(at, true);
    const double size = diagonal(cage.positions);
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      Vector3 position = Vector3::Zero(), du = Vector3::Zero(), dv = Vector3::Zero();
      double sum = 0, sum_du = 0, sum_dv = 0, most = 1;
      for (auto k = stencils.offsets[i]; k < stencils.offsets[i + 1]; ++k) {
        const Vector3 p = cage.positions.row(stencils.indices[k]);
        position += stencils.weights[k] * p, sum += stencils.weights[k];
        du += stencils.du_weights[k] * p, sum_du += stencils.du_weights[k];
        dv += stencils.dv_weights[k] * p, sum_dv += stencils.dv_weights[k];
        most = std::max({most, std::abs(stencils.du_weights[k]), std::abs(stencils.dv_weights[k])});
      }
      const std::string where = name + ", " + describe(at[i]);
      EXPECT_NEAR(sum, 1, 1e-13) << where;
      EXPECT_LE((position - Vector3(e.position.row(i))).norm(), 1e-13 * size) << where;
      for (const auto& [got, weights_sum, truth] :
           {std::tuple{du, sum_du, Vector3(e.du.row(i))}, {dv, sum_dv, Vector3(e.dv.row(i))}}) {
        EXPECT_EQ(got.hasNaN(), truth.hasNaN()) << where;
        if (truth.hasNaN()) continue;
        EXPECT_LE(std::abs(weights_sum), 1e-12 * most) << where;
        EXPECT_LE((got - truth).norm(), 1e-12 * most * size) << where;
      }
    }
  }
}

TEST(SharpSurfaces, BoundsAreTight) {
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    const auto bounds = surface.bounds();
    const Points fine = tessellate(surface, 5).positions;
    const double size = diagonal(cage.positions);
    const Eigen::RowVector3d low = fine.colwise().minCoeff(), high = fine.colwise().maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(bounds(0, axis), low[axis] + kPositionError * size) << name;
      EXPECT_GE(bounds(1, axis), high[axis] - kPositionError * size) << name;
      EXPECT_GE(bounds(0, axis), low[axis] - 2e-3 * size) << name;
      EXPECT_LE(bounds(1, axis), high[axis] + 2e-3 * size) << name;
    }
  }
}

/// The sum of the quads' areas, each divided into two triangles.
double polygonArea(const Tessellation& mesh) {
  double sum = 0;
  for (std::size_t q = 0; q < mesh.face_vertices.size(); q += 4) {
    const auto p = [&](int i) -> Vector3 { return mesh.positions.row(mesh.face_vertices[q + i]); };
    sum += ((p(1) - p(0)).cross(p(2) - p(0)).norm() + (p(2) - p(0)).cross(p(3) - p(0)).norm()) / 2;
  }
  return sum;
}

TEST(SharpSurfaces, AreaIsThatOfFineTessellations) {
  for (const auto& [name, cage] : sharpCages()) {
    const LimitSurface surface = limitSurface(cage);
    const double a4 = polygonArea(tessellate(surface, 4)), a5 = polygonArea(tessellate(surface, 5)),
                 a6 = polygonArea(tessellate(surface, 6));
    // The error of the polygons falls by a factor of 4 with each level.
    const double b5 = a5 + (a5 - a4) / 3, b6 = a6 + (a6 - a5) / 3;
    EXPECT_NEAR(surfaceArea(surface), b6, 10 * std::abs(b6 - b5) + 1e-8 * b6) << name;
    EXPECT_LE(std::abs(b6 - b5), 1e-3 * b6) << name;
  }
}

TEST(SharpSurfaces, TessellationsHaveEveryPointOnce) {
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    const int levels = 3, side = 1 << levels;
    const Tessellation mesh = tessellate(surface, levels);
    long expected = static_cast<long>(edgesOf(cage).size()) * (side - 1);
    std::vector<bool> used(cage.vertexCount(), false);
    for (const std::vector<int>& face : cage.faces) {
      for (int vertex : face) used[vertex] = true;
      const long n = static_cast<long>(face.size()), half = side / 2;
      expected +=
          n == 4 ? (side - 1) * (side - 1) : 1 + n * (half - 1) + n * (half - 1) * (half - 1);
    }
    expected += std::count(used.begin(), used.end(), true);
    EXPECT_EQ(mesh.positions.rows(), expected) << name;
    const Points position = surface.evaluate(mesh.locations).position;
    EXPECT_LE((position - mesh.positions).rowwise().norm().maxCoeff(),
              kPositionError * diagonal(cage.positions))
        << name;
    EXPECT_TRUE(mesh.normals.allFinite()) << name;
  }
}

TEST(SharpSurfaces, NewPosesAreAsGoodAsNewSurfaces) {
  Random random(3);
  for (const auto& [name, cage] : allCages()) {
    const Cage moved = perturbed(cage, 0.3, 99);
    LimitSurface surface = limitSurface(cage);
    surface.setPositions(moved.positions);
    const LimitSurface fresh = limitSurface(moved);
    const std::vector<Location> at = hereAndThere(cage, {2, 9, 30}, 1, random);
    for (const Derivatives order : kOrders) {
      const bool normals = order != Derivatives::none;
      const Evaluation a = surface.evaluate(at, order, normals),
                       b = fresh.evaluate(at, order, normals, 1);
      for (int i = 0; i < static_cast<int>(at.size()); ++i) {
        const Evaluation one = fresh.evaluate(std::vector{at[i]}, order, normals);
        for (int q = 0; q < kQuantities; ++q) {
          const Vector3 x = rowOf(a, i)[q], y = rowOf(b, i)[q], z = rowOf(one, 0)[q];
          EXPECT_TRUE((x.hasNaN() && y.hasNaN() && z.hasNaN()) || (x == y && y == z))
              << name << ", " << describe(at[i]) << ": " << kQuantityNames[q];
        }
      }
    }
  }
}

TEST(SharpSurfaces, VertexLocationsNameEveryVertex) {
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    const std::vector<Location> locations = surface.vertexLocations();
    ASSERT_EQ(static_cast<int>(locations.size()), cage.vertexCount());
    std::vector<bool> used(cage.vertexCount(), false);
    for (const std::vector<int>& face : cage.faces) {
      for (int vertex : face) used[vertex] = true;
    }
    for (int v = 0; v < cage.vertexCount(); ++v) {
      ASSERT_EQ(locations[v].face >= 0, used[v]) << name << ", vertex " << v;
      if (!used[v]) continue;
      ASSERT_NE(corners.at(locations[v]), nullptr);
      EXPECT_EQ(corners.at(locations[v])->vertex, v) << name;
    }
  }
}

TEST(SharpSurfaces, FramesAreAlwaysRotations) {
  Random random(4);
  for (const auto& [name, cage] : allCages()) {
    const LimitSurface surface = limitSurface(cage);
    std::vector<Location> at = everywhere(cage, {3, 40}, 1, random);
    const auto frames = surface.frames(at);
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> frame =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frames.data() + 9 * i);
      EXPECT_LE((frame * frame.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-13)
          << name << ", " << describe(at[i]);
      EXPECT_NEAR(frame.determinant(), 1, 1e-13) << name << ", " << describe(at[i]);
    }
  }
}

TEST(SharpSurfaces, CurvatureIsMissingAtIrregularVerticesAlone) {
  for (const auto& [name, cage] : sharpCages()) {
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    std::vector<Location> at;
    for (int face = 0; face < surface.faceCount(); ++face) {
      for (int corner = 0; corner < 4; ++corner) at.push_back(cornerLocation(face, corner));
      at.push_back({face, 0.5, 0.5});
    }
    const Curvature curvature = surface.curvature(at);
    for (int i = 0; i < static_cast<int>(at.size()); ++i) {
      const CornerPoint* corner = corners.at(at[i]);
      const bool regular = corner == nullptr || corner->regular();
      EXPECT_EQ(std::isnan(curvature.gaussian[i]), !regular) << name << ", " << describe(at[i]);
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
