// SPDX-License-Identifier: Apache-2.0
//
// What searches know of the faces around an extraordinary vertex as a whole, compared with points
// of the surface.
#include "limitsurf/search/rings/search_rings.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "limitsurf/pi.h"
#include "support/cages/meshes.h"
#include "support/cages/poles.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

TEST(RingBounds, HoldForPointsOfTheSurface) {
  int compared = 0;
  for (const auto& [name, cage] : poles()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 1, PatchUnit::own);
    const SearchRings rings(patches, 1e-13 * patches.diagonal());
    Random random(4);
    for (int ring = 0; ring < patches.ringCount(); ++ring) {
      const Eigen::Matrix3d frame = patches.ringFrame(ring);
      for (int level = rings.firstLevel(ring); level < rings.firstLevel(ring) + 12; ++level) {
        const RingLevel& known = rings.level(ring, level);
        for (int place = 0; place < std::min(9, rings.coreCount(ring)); ++place) {
          SurfacePatches::SplitCore split;
          patches.split(rings.core(ring, place, level), split);
          const Vector3 vertex = patches.coreVertex(split.core);
          const Vector3 point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
          const Vector3 seen = frame * point, line = random.vector(1).normalized();
          const double less = known.bounds.squaredDistanceLess(seen[2], seen.head<2>().norm());
          const double from_line =
              known.bounds.distanceFromLine(std::asin(std::abs((frame * line)[2])));
          for (const BezierPatch& patch : split.patches) {
            BezierPatch::Values at;
            patch.evaluate<0>(random.uniform(), random.uniform(), at);
            const Vector3 p = (patch.anchor + at.value).head<3>().matrix() - vertex;
            const Vector3 turned = frame * p;
            const double rho = turned.head<2>().norm(), z = turned[2], slack = 1e-15;
            EXPECT_GE(rho, known.bounds.nearest - slack) << name;
            EXPECT_LE(rho, known.bounds.farthest + slack) << name;
            EXPECT_LE(z, known.bounds.rise * rho * rho + slack) << name;
            EXPECT_LE(-z, known.bounds.fall * rho * rho + slack) << name;
            EXPECT_LE(std::abs(z), known.bounds.slope * rho + slack) << name;
            EXPECT_GE(p.dot(p - 2 * point), less - 4 * slack) << name;
            EXPECT_GE(p.cross(line).norm(), from_line - slack) << name;
            ++compared;
          }
          BezierPatch::Values at;
          patches.split(split.core, split);
          split.patches[1].evaluate<0>(random.uniform(), random.uniform(), at);
          const Vector3 p = (split.patches[1].anchor + at.value).head<3>().matrix() - vertex;
          EXPECT_GE(p.dot(p - 2 * point), known.restSquaredDistanceLess(seen) - 1e-15) << name;
        }
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

/// Bounds that are always true would be of no use.
TEST(RingBounds, TellThatTheVertexOfAConeIsNearest) {
  const LimitSurface surface = limitSurface(pole(40));
  const SurfacePatches patches(surface, 1, PatchUnit::own);
  const SearchRings rings(patches, 1e-13 * patches.diagonal());
  int large = 0;
  for (int ring = 0; ring < patches.ringCount(); ++ring) {
    if (!rings.isLarge(ring)) continue;
    ++large;
    const double outside =
        patches.ringFrame(ring)(2, 2) > 0 ? 1 : -1;  // the cone's tip points upwards
    for (int level = rings.firstLevel(ring); level < 40; ++level) {
      const RingBounds& bounds = rings.level(ring, level).bounds;
      EXPECT_GE(bounds.squaredDistanceLess(outside * 0.2, 0), 0) << level;
      EXPECT_GT(bounds.distanceFromLine(kPi<double> / 2), 0.5 * bounds.nearest) << level;
    }
    EXPECT_TRUE(rings.isSymmetric(ring, 0));
    EXPECT_FALSE(rings.isSymmetric(ring, 1e-12));
  }
  EXPECT_EQ(large, 1);
}

TEST(SearchRings, OnlyRegularPolygonsAreSymmetric) {
  for (const double noise : {0., 1e-9, 1e-3}) {
    Cage cage = pole(30);
    cage.positions(7, 2) += noise;
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 1, PatchUnit::own);
    const SearchRings rings(patches, 1e-13 * patches.diagonal());
    for (int ring = 0; ring < patches.ringCount(); ++ring) {
      if (rings.isLarge(ring)) {
        EXPECT_EQ(rings.isSymmetric(ring, 0), noise == 0) << noise;
      }
    }
  }
  const LimitSurface surface = limitSurface(openFan(30));
  const SurfacePatches patches(surface, 1, PatchUnit::own);
  const SearchRings rings(patches, 1e-13 * patches.diagonal());
  for (int ring = 0; ring < patches.ringCount(); ++ring) EXPECT_FALSE(rings.isSymmetric(ring, 0));
}

TEST(SectorTree, BoxesContainTheirFaces) {
  for (const auto& [name, cage] : poles()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 1, PatchUnit::own);
    const SearchRings rings(patches, 1e-13 * patches.diagonal());
    Random random(5);
    for (int ring = 0; ring < patches.ringCount(); ++ring) {
      for (const int level : {rings.firstLevel(ring), rings.firstLevel(ring) + 20}) {
        const SectorTree& sectors = rings.sectors(ring, level);
        for (int place = 0; place < rings.coreCount(ring); ++place) {
          SurfacePatches::SplitCore split;
          patches.split(rings.core(ring, place, level), split);
          const Vector3 vertex = patches.coreVertex(split.core);
          for (const BezierPatch& patch : split.patches) {
            BezierPatch::Values at;
            patch.evaluate<0>(random.uniform(), random.uniform(), at);
            const Vector3 p = (patch.anchor + at.value).head<3>().matrix() - vertex;
            for (int node = rings.coreCount(ring) + place; node >= SectorTree::kRoot; node /= 2) {
              EXPECT_LE(sectors.box(node).squaredDistance(p), 1e-30) << name;
              EXPECT_LE(sectors.box(node).squaredDistanceLess(p), -p.squaredNorm() + 1e-14) << name;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
