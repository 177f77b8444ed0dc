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
double trialsPerPoint(const Cage& cage) {
  const LimitSurface surface = limitSurface(cage);
  const SurfacePatches patches(surface);
  Box box;
  for (const auto& position : cage.positions.rowwise()) box.include(position.transpose());
  const double expected = 2. * static_cast<double>(cage.faces.size());
  const double radius = std::sqrt(0.7 * surfaceArea(surface) / expected);
  const DensityField everywhere;
  const SettlingCores settling(patches);
  PoissonDiscSampling sampling(patches, settling, box, everywhere, radius, AreaSampler::kGap,
                               expected, 1, 0);
  const std::size_t points = sampling.run([](std::size_t) {}).at.size();
  return static_cast<double>(sampling.trials()) / static_cast<double>(points);
}

Cage wavy(Cage cage) {
  for (int vertex = 0; vertex < cage.vertexCount(); ++vertex) {
    auto p = cage.positions.row(vertex);
    p[2] = std::sin(0.9 * p[0]) * std::sin(p[1]);
  }
  return cage;
}

/// A grid whose vertices, but for those of the boundary, are moved at random by several edges in
/// its plane, and by `height` times as much out of it: its faces fold over each other.
Cage folded(double height, std::uint64_t seed) {
  constexpr int kSide = 20;
  Cage cage = fullGrid(kSide, kSide);
  Random random(seed);
  for (int j = 1; j < kSide; ++j) {
    for (int i = 1; i < kSide; ++i) {
      const Vector3 move = random.vector(4);
      cage.positions.row(i + (kSide + 1) * j) +=
          Eigen::RowVector3d(move[0], move[1], height * move[2]);
    }
  }
  return cage;
}

TEST(PoissonDiscSampling, TakesFewTrialsForEachPoint) {
  const Cage quads = perturbed(grid(40, 40), 0.1, 1);
  Cage triangles = quads;
  triangles.faces.clear();
  for (const std::vector<int>& f : quads.faces) {
    triangles.faces.push_back({f[0], f[1], f[2]});
    triangles.faces.push_back({f[0], f[2], f[3]});
  }
  EXPECT_LE(trialsPerPoint(wavy(quads)), 20);
  EXPECT_LE(trialsPerPoint(wavy(triangles)), 36);
}

/// No disc sees both sheets of a fold. Cells on folds were divided until they were as small as a
/// gap, which took some thousand trials for each point, whether the sheets were in one plane or
/// nearly so.
TEST(PoissonDiscSampling, TakesABoundedNumberOfTrialsAtFolds) {
  for (const double height : {0., 1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.1, 1.}) {
    for (const std::uint64_t seed : {1, 2}) {
      const double trials = trialsPerPoint(folded(height, seed));
      EXPECT_LE(trials, 1000) << height;
    }
  }
}

/// What is said to be seen is seen, and what is left is a strip as narrow as it is said to be.
TEST(PoissonDiscSampling, DiscsSeeTheSidesOfFoldsAsFarAsBoundsTell) {
  Random random(3);
  int seen_places = 0, known_widths = 0;
  for (int round = 0; round < 400; ++round) {
    // A patch with a fold along t, in space or nearly in a plane.
    BezierPatch patch;
    patch.anchor.setZero();
    const double height = round % 4 == 0 ? 0 : std::pow(10., -random.uniform(0, 8));
    for (int i = 0; i < 16; ++i) {
      const int row = i / 4, column = i % 4;
      const double s = column / 3. - 0.5, t = row / 3.;
      const Vector3 bump = random.vector(0.1);
      patch.points[i] = {s * s + bump[0], t + bump[1], height * (s + 3 * bump[2]), 0};
    }
    const BoundedPatch bounded(patch);
    TrialCell cell;
    cell.s_level = cell.t_level = static_cast<std::uint8_t>(2 + round % 7);
    cell.column = random.below(std::uint32_t{1} << cell.s_level);
    cell.row = random.below(std::uint32_t{1} << cell.t_level);
    const TurningNormals normals = bounded.turningNormals(cell);
    const Vector3 unit = random.vector(1).normalized();
    const bool is_up = unit.dot(normals.axis) > 0;
    const double above = normals.seenAbove(unit, is_up ? normals.axis : Vector3(-normals.axis));
    const auto at = [&](double s, double t) {
      BezierPatch::Values values;
      patch.evaluate<1>((cell.column + s) * cell.width(), (cell.row + t) * cell.height(), values);
      return values;
    };
    const auto alongAxis = [&](const BezierPatch::Values& values) {
      return limitsurf::cross(values.ds, values.dt).dot(normals.axis);
    };
    const auto isNarrow = [&](const BezierPatch::Values& one, const BezierPatch::Values& other) {
      return length(BezierPatch::Point(one.value - other.value)) <=
             (1 + 1e-9) * normals.width * std::abs(alongAxis(one) - alongAxis(other));
    };
    bool narrow_along_s = true, narrow_along_t = true;
    for (int i = 0; i < 100; ++i) {
      const double s = random.uniform(), t = random.uniform();
      const BezierPatch::Values place = at(s, t);
      const Vector3 normal = limitsurf::cross(place.ds, place.dt);
      const double along = alongAxis(place);
      EXPECT_GE(along, normals.low);
      EXPECT_LE(along, normals.high);
      EXPECT_LE((normal - along * normals.axis - normals.beside).norm(), normals.spread);
      if ((is_up ? along : -along) > above) {
        EXPECT_TRUE(seeEachOther(unit, normal.normalized()));
        ++seen_places;
      }
      narrow_along_s &= isNarrow(place, at(random.uniform(), t));
      narrow_along_t &= isNarrow(place, at(s, random.uniform()));
    }
    if (std::isfinite(normals.width)) {
      EXPECT_TRUE(narrow_along_s || narrow_along_t);
      ++known_widths;
    }
  }
  EXPECT_GT(seen_places, 4000);
  EXPECT_GT(known_widths, 200);
}

/// First cells no larger than discs would be slivers: they took 453 trials for each point.
TEST(PoissonDiscSampling, TakesFewerTrialsOnSliversWithLargeFirstCells) {
  EXPECT_LE(trialsPerPoint(wavy(pole(512))), 345);
}

/// The core of each tile that has one.
std::vector<SurfacePiece> coresOf(const SurfacePatches& patches) {
  std::vector<SurfacePiece> pieces, cores;
  for (int tile = 0; tile < patches.tileCount(); ++tile) {
    pieces.clear();
    patches.appendPieces(tile, pieces);
    if (pieces.front().isCore()) cores.push_back(pieces.front());
  }
  return cores;
}

TEST(PoissonDiscSampling, CoresLieWithinTheirReachAndTheirCones) {
  Random random(4);
  int with_cone = 0, all = 0;
  for (const auto& [name, cage] : everyNth(queryCages(), 3)) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface);
    const SettlingCores settling(patches);
    const double gap = 1e-4 * patches.diagonal();
    for (const SurfacePiece& core : coresOf(patches)) {
      CoreDescent descent(patches, settling, core, gap);
      const double first_reach = descent.reach();
      const NormalCone cone = descent.cone();
      EXPECT_LE(descent.reach(), first_reach * (1 + 1e-12));
      ++all;
      Vector3 unit(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      unit.normalize();
      const bool faced = cone.isFacedBy(unit) || cone.isFacedBy(unit = -unit);
      with_cone += faced;
      EXPECT_TRUE(!faced || descent.facesAll(unit));
      const FaceRectangle on = patches.rectangle(core);
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
            (position - patches.coreVertex(core)).norm() > gap) {
          EXPECT_GT(normal.dot(unit), 0);
        }
      }
    }
  }
  EXPECT_GT(with_cone, all / 8);
}

/// Unit normals at places of the patches of many steps of a core.
std::vector<Vector3> normalsOf(const SurfacePatches& patches, SurfacePiece core, Random& random) {
  constexpr int kSteps = 20, kPlaces = 6;
  std::vector<Vector3> normals;
  SurfacePatches::SplitCore split;
  for (int step = 0; step < kSteps; ++step) {
    patches.split(core, split);
    for (const BezierPatch& patch : split.patches) {
      for (int place = 0; place < kPlaces; ++place) {
        BezierPatch::Values at;
        patch.evaluate<1>(random.below(3) / 2., random.uniform(), at);
        const Vector3 ds = at.ds.head<3>(), dt = at.dt.head<3>(), normal = ds.cross(dt);
        if (normal.norm() > 1e-6 * ds.norm() * dt.norm()) normals.push_back(normal.normalized());
      }
    }
    core = split.core;
  }
  return normals;
}

/// Directions nearly perpendicular to some normal, on the side of all the others, are the ones that
/// too narrow a bound would accept. Cores are whole or have been split before.
TEST(PoissonDiscSampling, DirectionsThatFaceACoreFaceTheNormalsOfManySteps) {
  Random random(5);
  int faced = 0, near = 0;
  for (const double noise : {0.02, 0.1, 0.3}) {
    for (const double height : {1., 0.1, 3.}) {
      Cage cage = perturbed(inTriangles(torus(6, 4)), noise, 1);
      cage.positions.col(2) *= height;
      const LimitSurface surface = limitSurface(cage);
      const SurfacePatches patches(surface);
      const SettlingCores settling(patches);
      const double gap = 1e-5 * patches.diagonal();
      for (SurfacePiece core : coresOf(patches)) {
        SurfacePatches::SplitCore split;
        for (int step = random.below(4); step > 0; --step) {
          patches.split(core, split);
          core = split.core;
        }
        const std::vector<Vector3> normals = normalsOf(patches, core, random);
        Vector3 mean = Vector3::Zero();
        for (const Vector3& normal : normals) mean += normal;
        CoreDescent descent(patches, settling, core, gap);
        const NormalCone cone = CoreDescent(patches, settling, core, gap).cone();
        for (int i = 0; i < 20; ++i) {
          const Vector3& normal = normals[random.below(static_cast<int>(normals.size()))];
          const Vector3 aside = (mean - mean.dot(normal) * normal).normalized();
          const Vector3 unit = (aside + random.uniform(-0.1, 0.3) * normal).normalized();
          if (!descent.facesAll(unit) && !cone.isFacedBy(unit)) continue;
          ++faced;
          double least = 1;
          for (const Vector3& other : normals) least = std::min(least, other.dot(unit));
          ASSERT_GT(least, -1e-9) << noise << " " << height << " " << core.tile << " "
                                  << core.steps;
          near += least < 0.1;
        }
      }
    }
  }
  EXPECT_GT(faced, 2000);
  EXPECT_GT(near, 200);
}

}  // namespace
}  // namespace limitsurf::test
