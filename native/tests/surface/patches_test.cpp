// SPDX-License-Identifier: Apache-2.0
//
// The surface as bicubic patches: they have the points of evaluation and subdivision, they cover
// each place once, and boxes contain the parts that they should.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "limitsurf/surface/patches/surface_patches.h"
#include "support/cages/query_cages.h"
#include "support/truth/corner_points.h"
#include "support/truth/witness.h"

namespace limitsurf::test {
namespace {

/// All patches of a surface whose cores have been split `steps` times, and the rest of the cores.
struct Pieces {
  Pieces(const SurfacePatches& surface_patches, int steps) {
    std::vector<SurfacePiece> pieces;
    for (int tile = 0; tile < surface_patches.tileCount(); ++tile) {
      const std::size_t before = pieces.size();
      surface_patches.appendPieces(tile, pieces);
      EXPECT_EQ(pieces.size() - before, static_cast<std::size_t>(surface_patches.pieceCount(tile)));
    }
    for (SurfacePiece piece : pieces) {
      if (!piece.isCore()) {
        patches.push_back(surface_patches.patch(piece));
        continue;
      }
      SurfacePatches::SplitCore split;
      for (int step = 0; step < steps; ++step) {
        surface_patches.split(piece, split);
        patches.insert(patches.end(), split.patches, split.patches + 3);
        piece = split.core;
      }
      cores.push_back(piece);
    }
  }
  std::vector<BezierPatch> patches;
  std::vector<SurfacePiece> cores;
};

Vector3 pointOf(const BezierPatch& patch, double s, double t) {
  BezierPatch::Values at;
  patch.evaluate<0>(s, t, at);
  return (patch.anchor + at.value).head<3>().matrix();
}

double areaOf(const FaceRectangle& on) { return std::abs(on.us * on.vt - on.ut * on.vs); }

bool inside(const Box& box, const Vector3& point, double slack) {
  return (point - box.low).minCoeff() >= -slack && (box.high - point).minCoeff() >= -slack;
}

TEST(Patches, AreTheSurface) {
  double worst = 0;
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    const double unit = diagonal(cage.positions);
    EXPECT_EQ(patches.diagonal(), unit) << name;
    for (const BezierPatch& patch : Pieces(patches, 9).patches) {
      std::vector<Location> at;
      std::vector<Vector3> points;
      for (const double s : {0., 0.3, 0.75, 1.}) {
        for (const double t : {0., 0.45, 1.}) {
          at.push_back(patch.on.at(s, t));
          points.push_back(pointOf(patch, s, t));
        }
      }
      const Points positions = surface.evaluate(at).position;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const double error =
            (Vector3(positions.row(static_cast<Eigen::Index>(i))) - points[i]).norm() / unit;
        EXPECT_LE(error, kPositionError) << name << ", " << describe(at[i]);
        worst = std::max(worst, error);
      }
    }
  }
  std::printf("worst error of a patch: %.2g\n", worst);
}

TEST(Patches, AreTheSurfaceOfSubdivisionIn50Digits) {
  Random random(1);
  double worst = 0;
  for (const auto& [name, cage] : queryCages()) {
    if (cage.options.scheme != Scheme::catmark || !cage.options.holes.empty() ||
        name == "refused face") {
      continue;
    }
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    DeepSubdivision deep(cage);
    const Pieces pieces(patches, 20);
    for (int i = 0; i < 12; ++i) {
      const BezierPatch& patch =
          pieces.patches[random.below(static_cast<int>(pieces.patches.size()))];
      const double s = random.uniform(0.05, 0.95), t = random.uniform(0.05, 0.95);
      const Location at = patch.on.at(s, t);
      const double error =
          (deep.evaluate(at)[kPosition] - pointOf(patch, s, t)).norm() / patches.diagonal();
      EXPECT_LE(error, kPositionError) << name << ", " << describe(at);
      worst = std::max(worst, error);
    }
  }
  std::printf("worst error of a patch: %.2g\n", worst);
}

TEST(Patches, CoverEachFaceOnce) {
  Random random(2);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    const Pieces pieces(patches, 3);
    std::vector<FaceRectangle> rectangles;
    for (const BezierPatch& patch : pieces.patches) rectangles.push_back(patch.on);
    for (const SurfacePiece& core : pieces.cores) rectangles.push_back(patches.rectangle(core));
    std::vector<double> areas(static_cast<std::size_t>(surface.faceCount()), 0.);
    for (const FaceRectangle& on : rectangles) {
      ASSERT_TRUE(on.face >= 0 && on.face < surface.faceCount()) << name;
      areas[static_cast<std::size_t>(on.face)] += areaOf(on);
    }
    for (int face = 0; face < surface.faceCount(); ++face) {
      const bool refused = surface.refused().count(surface.baseFace()[face]) != 0;
      EXPECT_NEAR(areas[static_cast<std::size_t>(face)], refused ? 0 : 1, 1e-12)
          << name << ", face " << face;
    }
    for (const Location& at : searchedLocations(surface, 100, random)) {
      int around = 0, within = 0;
      for (const FaceRectangle& on : rectangles) {
        if (on.face != at.face) continue;
        const double u0 = std::min(on.u0, on.u0 + on.us + on.ut),
                     u1 = std::max(on.u0, on.u0 + on.us + on.ut),
                     v0 = std::min(on.v0, on.v0 + on.vs + on.vt),
                     v1 = std::max(on.v0, on.v0 + on.vs + on.vt);
        around += at.u >= u0 && at.u <= u1 && at.v >= v0 && at.v <= v1;
        within += at.u > u0 && at.u < u1 && at.v > v0 && at.v < v1;
      }
      EXPECT_GE(around, 1) << name << ", " << describe(at);
      EXPECT_LE(within, 1) << name << ", " << describe(at);
    }
  }
}

TEST(Patches, CoresLieInTheirBoxes) {
  Random random(3);
  for (const auto& [name, cage] : queryCages()) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    const double slack = kPositionError * patches.diagonal();
    for (SurfacePiece core : Pieces(patches, 0).cores) {
      SurfacePatches::SplitCore split;
      Box box = patches.coreBox(core);
      for (int step = 0; step < 70; ++step) {
        const FaceRectangle on = patches.rectangle(core);
        std::vector<Location> at = {on.at(0, 0), on.at(1, 0), on.at(0, 1), on.at(1, 1)};
        for (int i = 0; i < 3; ++i) at.push_back(on.at(random.uniform(), random.uniform()));
        const Points points = surface.evaluate(at, Derivatives::none, false, 1).position;
        EXPECT_LE((Vector3(points.row(0)) - patches.coreVertex(core)).norm(), slack) << name;
        for (Eigen::Index i = 0; i < points.rows(); ++i) {
          EXPECT_TRUE(inside(box, points.row(i), slack))
              << name << ", " << describe(at[static_cast<std::size_t>(i)]) << " after " << step;
        }
        patches.split(core, split);
        for (int quarter = 0; quarter < 3; ++quarter) {
          const FaceRectangle there = patches.rectangle(split.pieces[quarter]);
          EXPECT_TRUE(there.at(0.5, 0.5).u == split.patches[quarter].on.at(0.5, 0.5).u);
          EXPECT_LE((pointOf(patches.patch(split.pieces[quarter]), 0.25, 0.5) -
                     pointOf(split.patches[quarter], 0.25, 0.5))
                        .norm(),
                    0.01 * slack)
              << name << " after " << step;
        }
        core = split.core;
        box = split.core_box;
      }
      EXPECT_LE(patches.coreRadius(core), 1e-5 * patches.diagonal()) << name;
    }
  }
}

TEST(Patches, BordersAreWhereTheSurfaceEndsOrIsSharp) {
  for (const auto& [name, cage] : queryCages()) {
    if (cage.options.scheme != Scheme::catmark || !isManifold(cage.faces)) continue;
    const LimitSurface surface = limitSurface(cage);
    const CornerPoints corners(cage);
    for (const BezierPatch& patch : Pieces(SurfacePatches(surface), 4).patches) {
      const std::pair<unsigned, Location> sides[] = {{kSideS0, patch.on.at(0, 0.5)},
                                                     {kSideS1, patch.on.at(1, 0.5)},
                                                     {kSideT0, patch.on.at(0.5, 0)},
                                                     {kSideT1, patch.on.at(0.5, 1)}};
      for (const auto& [side, at] : sides) {
        EXPECT_EQ((patch.borders & side) != 0, isOnBorder(corners, at))
            << name << ", " << describe(at);
      }
    }
  }
}

TEST(Patches, FollowThePose) {
  const Cage cage = closedCages()[1].second;
  LimitSurface surface = limitSurface(cage);
  const Points moved = (2 * cage.positions).rowwise() + Eigen::RowVector3d(1, 2, 3);
  surface.setPositions(moved);
  const SurfacePatches patches(surface);
  EXPECT_NEAR(patches.diagonal(), 2 * diagonal(cage.positions), 1e-12);
  for (const BezierPatch& patch : Pieces(patches, 5).patches) {
    const Location at = patch.on.at(0.3, 0.6);
    const Vector3 position = surface.evaluate({&at, 1}).position.row(0);
    EXPECT_LE((position - pointOf(patch, 0.3, 0.6)).norm(), kPositionError * patches.diagonal());
  }
}

}  // namespace
}  // namespace limitsurf::test
