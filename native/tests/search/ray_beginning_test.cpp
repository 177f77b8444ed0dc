// SPDX-License-Identifier: Apache-2.0
//
// Rays that begin on the surface hit it where they begin, in whatever direction they go.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "limitsurf/search/surface_search.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"

namespace limitsurf::test {
namespace {

Cage square() {
  Cage cage = fullGrid(1, 1);
  cage.options.boundary = Boundary::corners;
  return cage;
}

Cage creasedCube() {
  Cage cage = cube();
  for (const std::vector<int>& face : cage.faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      cage.options.edge_sharpness.edges.push_back({face[k], face[(k + 1) % face.size()]});
      cage.options.edge_sharpness.values.push_back(10);
    }
  }
  return cage;
}

/// Half a cylinder: its rulings lie on the surface.
Cage halfPipe() {
  Cage cage = fullGrid(6, 4);
  for (Eigen::Index i = 0; i < cage.positions.rows(); ++i) {
    const double angle = cage.positions(i, 0) / 2;
    cage.positions.row(i) << std::cos(angle), cage.positions(i, 1), std::sin(angle);
  }
  return cage;
}

TEST(RayCast, HitsWhereItBeginsOnTheSurface) {
  Random random(12);
  const std::pair<const char*, Cage> cages[] = {
      {"square", square()},
      {"grid", perturbed(fullGrid(4, 4), 0, 1)},
      {"creased cube", creasedCube()},
      {"half pipe", halfPipe()},
      {"cube", cube()},
      {"noisy grid", perturbed(fullGrid(5, 5), 0.3, 7)},
      {"pole", pole(9)},
  };
  for (const auto& [name, cage] : cages) {
    const LimitSurface surface = limitSurface(cage);
    const SurfaceSearch search(surface);
    const std::vector<Location> at = searchedLocations(surface, 120, random);
    const Evaluation e = surface.evaluate(at, Derivatives::first, true);
    const double allowed = kSearchError * diagonal(cage.positions);
    for (int kind = 0; kind < 5; ++kind) {
      Points directions(e.position.rows(), 3);
      for (Eigen::Index i = 0; i < directions.rows(); ++i) {
        const Vector3 du = e.du.row(i), dv = e.dv.row(i), normal = e.normal.row(i);
        const double angle = random.uniform(0, 6.28);
        Vector3 direction = kind == 0   ? du
                            : kind == 1 ? Vector3(-dv)
                            : kind == 2 ? Vector3(std::cos(angle) * du + std::sin(angle) * dv)
                            : kind == 3 ? Vector3(du + 1e-7 * du.norm() * normal)
                                        : random.vector(1);
        if (!(direction.norm() > 0) || !direction.allFinite()) {
          direction = Vector3::UnitX();
        }
        directions.row(i) = direction.transpose();
      }
      const Hits hits = search.rayCast(e.position, directions);
      const RayHits all = search.rayCastAll(e.position, directions);
      int missed = 0;
      for (Eigen::Index i = 0; i < directions.rows(); ++i) {
        missed += hits.distance[i] <= allowed ? 0 : 1;
        const std::int64_t first = all.offsets[static_cast<std::size_t>(i)];
        ASSERT_LT(first, all.offsets[static_cast<std::size_t>(i) + 1]) << name << ", " << kind;
        EXPECT_NEAR(all.distance[first], hits.distance[i], allowed) << name << ", " << kind;
      }
      EXPECT_EQ(missed, 0) << name << ", direction " << kind;
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
