// SPDX-License-Identifier: Apache-2.0
//
// The normals of the patches around a vertex are within the bounds that CoreTangents gives for the
// steps that are still to come.
#include "limitsurf/surface/patches/core_tangents.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <vector>

#include "limitsurf/surface/patches/surface_patches.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// More than the rounding of the normals of patches after 30 steps.
constexpr double kRounding = 1e-6;
constexpr int kSteps = 30;

std::vector<SurfacePiece> coresOf(const SurfacePatches& patches) {
  std::vector<SurfacePiece> pieces, cores;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    patches.appendPieces(tile, pieces);
  }
  for (const SurfacePiece& piece : pieces) {
    if (piece.isCore() && patches.coreValence(piece) <= SurfacePatches::kFewFaces) {
      cores.push_back(piece);
    }
  }
  return cores;
}

/// The largest slope of a normal against an axis, among some places of three patches.
double largestSlope(const SurfacePatches::SplitCore& split, const Vector3& axis, Random& random) {
  double largest = 0;
  for (const BezierPatch& patch : split.patches) {
    for (int place = 0; place < 6; ++place) {
      BezierPatch::Values at;
      patch.evaluate<1>(random.below(3) / 2., random.uniform(), at);
      const Vector3 normal = Vector3(at.ds.head<3>()).cross(Vector3(at.dt.head<3>()));
      const double rise = normal.dot(axis);
      largest = std::max(largest, rise > 0 ? normal.cross(axis).norm() / rise : HUGE_VAL);
    }
  }
  return largest;
}

struct Counts {
  int known = 0, narrow = 0, unknown = 0;
};

void checkCores(const Cage& cage, const std::string& name, Random& random, Counts& counts) {
  const LimitSurface surface = limitSurface(cage);
  const SurfacePatches patches(surface);
  std::map<SurfacePatches::CoreKind, CoreTangents> tangents;
  for (const auto& [kind, count] : patches.coreKinds()) {
    tangents.emplace(kind, CoreTangents(*kind.first, kind.second));
  }
  for (SurfacePiece core : coresOf(patches)) {
    Padded points[SurfacePatches::kMostCorePoints];
    CoreTangents::Settling settling;
    if (!patches.corePoints(core, points) ||
        !tangents.at(patches.coreKind(core)).settle(points, settling)) {
      ++counts.unknown;
      continue;
    }
    ++counts.known;
    counts.narrow += settling.slopeAfter(12) < 0.2;
    const int first = core.steps;
    std::vector<double> slopes(static_cast<std::size_t>(first), 0);
    SurfacePatches::SplitCore split;
    while (core.steps < kSteps) {
      patches.splitPatches(core, split);
      slopes.push_back(largestSlope(split, settling.normal(), random));
      core = split.core;
    }
    for (int n = first; n < CoreTangents::kSteps; ++n) {
      for (std::size_t later = static_cast<std::size_t>(n); later < slopes.size(); ++later) {
        ASSERT_LE(slopes[later], settling.slopeAfter(n) + kRounding)
            << name << ": " << n << ", " << later;
      }
    }
  }
}

TEST(CoreTangents, BoundAllNormalsThatFollow) {
  Random random(1);
  Counts counts;
  for (const auto& [name, cage] : queryCages()) {
    checkCores(cage, name, random, counts);
  }
  for (int valence = 3; valence <= SurfacePatches::kFewFaces; ++valence) {
    for (const double noise : {0., 0.02, 0.2}) {
      checkCores(perturbed(fan(valence, true, 1), noise, 1), std::to_string(valence), random,
                 counts);
    }
  }
  EXPECT_GT(counts.known, 1000);
  EXPECT_GT(counts.narrow, counts.known / 2);
  EXPECT_GT(counts.unknown, 100);
}

}  // namespace
}  // namespace limitsurf::test
