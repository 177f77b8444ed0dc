// SPDX-License-Identifier: Apache-2.0
//
// What blue noise costs, counted in trials, and the bounds by which it tells what a disc covers.
#include "limitsurf/sample/blue_noise/poisson_disc_sampling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_sampler.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"

namespace limitsurf::test {
namespace {

/// The number of trials for each point, where there are about two points for each face.
double trialsPerPoint(Cage cage) {
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    auto p = cage.positions.row(vertex);
    p[2] = std::sin(0.9 * p[0]) * std::sin(p[1]);
  }
  const LimitSurface surface = limitSurface(cage);
  const SurfacePatches patches(surface);
  Box box;
  for (const auto& position : cage.positions.rowwise()) box.include(position.transpose());
  const double expected = 2. * static_cast<double>(cage.faces.size());
  const double radius = std::sqrt(0.7 * surfaceArea(surface) / expected);
  const DensityField everywhere;
  PoissonDiscSampling sampling(patches, box, everywhere, radius, AreaSampler::kGap, expected, 1, 0);
  const std::size_t points = sampling.run([](std::size_t) {}).at.size();
  return static_cast<double>(sampling.trials()) / static_cast<double>(points);
}

TEST(PoissonDiscSampling, TakesFewTrialsForEachPoint) {
  const Cage quads = perturbed(grid(40, 40), 0.1, 1);
  Cage triangles = quads;
  triangles.faces.clear();
  for (const std::vector<int>& f : quads.faces) {
    triangles.faces.push_back({f[0], f[1], f[2]});
    triangles.faces.push_back({f[0], f[2], f[3]});
  }
  EXPECT_LE(trialsPerPoint(quads), 20);
  EXPECT_LE(trialsPerPoint(triangles), 36);
}

/// First cells no larger than discs would be slivers: they took 453 trials for each point.
TEST(PoissonDiscSampling, TakesFewerTrialsOnSliversWithLargeFirstCells) {
  EXPECT_LE(trialsPerPoint(pole(512)), 345);
}

TEST(PoissonDiscSampling, CoresLieWithinTheirReachAndTheirCones) {
  Random random(4);
  int with_cone = 0, all = 0;
  for (const auto& [name, cage] : everyNth(queryCages(), 3)) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    const double gap = 1e-4 * patches.diagonal();
    std::vector<SurfacePiece> pieces;
    for (int tile = 0; tile < patches.tileCount(); ++tile) {
      pieces.clear();
      patches.appendPieces(tile, pieces);
      if (!pieces.front().isCore()) continue;
      CoreDescent descent(patches, pieces.front(), gap);
      const double first_reach = descent.reach();
      const NormalCone cone = descent.cone();
      EXPECT_LE(descent.reach(), first_reach * (1 + 1e-12));
      ++all;
      Vector3 unit(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      unit.normalize();
      const bool faced = cone.isFacedBy(unit) || cone.isFacedBy(unit = -unit);
      with_cone += faced;
      EXPECT_TRUE(!faced || descent.facesAll(unit));
      const FaceRectangle on = patches.rectangle(pieces.front());
      std::vector<Location> at;
      for (int i = 0; i < 24; ++i) {
        const double size = std::ldexp(1., -(i % 6));
        at.push_back(on.at(size * random.uniform(), size * random.uniform()));
      }
      const Evaluation e = surface.evaluate(at, Derivatives::first, true);
      for (Eigen::Index i = 0; i < e.position.rows(); ++i) {
        const Vector3 position = e.position.row(i), normal = e.normal.row(i);
        EXPECT_LE((position - descent.middle()).norm(),
                  descent.reach() + kPositionError * patches.diagonal());
        if (faced && std::isfinite(normal[0]) &&
            (position - patches.coreVertex(pieces.front())).norm() > gap) {
          EXPECT_GT(normal.dot(unit), 0);
        }
      }
    }
  }
  EXPECT_GT(with_cone, all / 8);
}

}  // namespace
}  // namespace limitsurf::test
