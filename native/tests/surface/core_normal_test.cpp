// SPDX-License-Identifier: Apache-2.0
//
// Integrals of ds x dt over whole cores, against sums over many explicit subdivision steps.
#include "limitsurf/surface/patches/core_normal.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "limitsurf/surface/batch/grid_step.h"
#include "limitsurf/surface/bezier_conversion.h"
#include "limitsurf/surface/bezier_patch.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// Gauss's rule with 3 points a side, which integrates ds x dt exactly.
Vector3 integratedNormal(const BezierPatch& patch) {
  const double at[3] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[3] = {5, 8, 5};
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 9; ++i) {
    BezierPatch::Values p;
    patch.evaluate<1>(at[i % 3], at[i / 3], p);
    const Vector3 ds = p.ds.head<3>(), dt = p.dt.head<3>();
    sum += weight[i % 3] * weight[i / 3] / (18 * 18) * ds.cross(dt);
  }
  return sum;
}

Vector3 patchesOfStep(const Padded* grid, Sides sides) {
  Vector3 sum = Vector3::Zero();
  for (int quarter = 1; quarter < 4; ++quarter) {
    const int a = quarter % 2, b = quarter / 2;
    BezierPatch patch;
    for (int i = 0; i < 16; ++i) {
      patch.points[i] = grid[(b + i / 4) * tile_grid::kSize + a + i % 4];
    }
    continueSides(patch.points, onRight(sides) && a == 0, false, onLeft(sides) && b == 0, false);
    convertBothWays(patch.points, toBezier<Padded>);
    sum += integratedNormal(patch);
  }
  return sum;
}

void expectSumOfSteps(const Ring& ring, int face, Random& random) {
  const std::shared_ptr<const Eigenbasis> basis = Eigenbasis::get(ring);
  const std::vector<int>& slots = basis->outerModes(face).slots();
  std::vector<Padded> points(static_cast<std::size_t>(ring.size()) + slots.size());
  for (Padded& point : points) {
    point.setZero();
    point.head<3>() = random.vector(1).array();
  }
  const GridStep step(ring, face);
  Padded grid[tile_grid::kSlots], after[tile_grid::kSlots];
  std::fill_n(grid, tile_grid::kSlots, Padded::Zero());
  std::fill_n(after, tile_grid::kSlots, Padded::Zero());
  step.setRing(points.data(), grid);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    grid[slots[i]] = points[static_cast<std::size_t>(ring.size()) + i];
  }
  std::vector<Padded> of_ring(points.begin(), points.begin() + ring.size()), next(of_ring);
  Vector3 sum = Vector3::Zero();
  for (int n = 0; n < 60; ++n) {
    basis->step().apply([&](int i) -> const Padded& { return of_ring[i]; },
                        [&](int i) -> Padded& { return next[i]; });
    of_ring.swap(next);
    step.apply(of_ring.data(), grid, after);
    std::copy(after, after + tile_grid::kSlots, grid);
    sum += patchesOfStep(grid, basis->sides(face));
  }
  const CoreNormal::Value value = CoreNormal(*basis, face).value(points.data());
  EXPECT_LE((value.normal - sum).norm(), 1e-13 + value.rounding);
  EXPECT_LE(value.rounding, 1e-12);
}

TEST(CoreNormal, IsTheSumOverAllSteps) {
  Random random(1);
  for (const RingKind kind : {RingKind::interior, RingKind::boundary, RingKind::pinned,
                              RingKind::cone, RingKind::dart, RingKind::tip, RingKind::loop}) {
    for (int faces = 3; faces <= 6; ++faces) {
      const Ring ring = {kind, faces};
      for (int face = 0; face < faces; ++face) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << " " << faces << " " << face);
        expectSumOfSteps(ring, face, random);
      }
    }
  }
  for (const RingKind kind : {RingKind::boundary, RingKind::pinned}) {
    expectSumOfSteps({kind, 1}, 0, random);
    expectSumOfSteps({kind, 2}, 1, random);
  }
}

}  // namespace
}  // namespace limitsurf::test
