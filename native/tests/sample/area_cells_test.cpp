// SPDX-License-Identifier: Apache-2.0
//
// The cells that uniform samples are drawn from: their bounds hold, and there are few of them.
#include "limitsurf/sample/area_cells.h"

#include <gtest/gtest.h>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_form.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/sample/core_tail.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "support/cages/meshes.h"
#include "support/cages/query_cages.h"

namespace limitsurf::test {
namespace {

/// |ds x dt| at a random place of a rectangle of a patch's parameters, by the rectangle's own.
double areaAt(const BezierPatch& patch, double s0, double t0, double side, Random& random) {
  BezierPatch::Values values;
  patch.evaluate<1>(s0 + side * random.uniform(), t0 + side * random.uniform(), values);
  return length(limitsurf::cross(values.ds, values.dt)) * side * side;
}

Cage halved(const Cage& quads) {
  Cage triangles = quads;
  triangles.faces.clear();
  for (const std::vector<int>& f : quads.faces) {
    triangles.faces.push_back({f[0], f[1], f[2]});
    triangles.faces.push_back({f[0], f[2], f[3]});
  }
  return triangles;
}

/// Otherwise what is left of the area, which is rounding errors, would be cut into ever more cells.
TEST(AreaCells, SurfacesOnALineHaveNoArea) {
  const auto hasArea = [](const Cage& cage) {
    const LimitSurface surface = limitSurface(cage);
    return !areaCells(SurfacePatches(surface, 0, PatchUnit::own), 0).empty();
  };
  const Eigen::RowVector3d along(0.3, 0.7, 0.11), across(0.7, -0.3, 0.02);
  Random random(5);
  for (const Cage& quads : {grid(5, 5), cube(), pole(12)}) {
    for (const bool in_triangles : {false, true}) {
      Cage cage = in_triangles && quads.faces[0].size() == 4 ? halved(quads) : quads;
      Cage thin = cage;
      for (Eigen::Index vertex = 0; vertex < cage.positions.rows(); ++vertex) {
        cage.positions.row(vertex) = random.uniform() * along;
        thin.positions.row(vertex) = cage.positions.row(vertex) + 1e-11 * random.uniform() * across;
      }
      EXPECT_FALSE(hasArea(cage));
      EXPECT_TRUE(hasArea(thin));
    }
    Cage small = quads;  // all faces but those of one vertex are small
    small.positions *= 1e-9;
    small.positions.row(0) << 1, 0, 0;
    EXPECT_TRUE(hasArea(small));
  }
}

TEST(AreaCells, AreasAreWithinTheirBounds) {
  Random random(3);
  NamedCages cages = everyNth(queryCages(), 2);
  Cage stretched = perturbed(halved(grid(4, 4)), 0.2, 1);
  stretched.positions.col(0) *= 1e4;
  cages.push_back({"stretched triangles", stretched});
  for (const auto& [name, cage] : cages) {
    SCOPED_TRACE(name);
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 0, PatchUnit::own);
    for (const AreaCell& cell : areaCells(patches, 0)) {
      if (!cell.piece.isCore()) {
        const double side = std::ldexp(1., -cell.level);
        for (int i = 0; i < 4; ++i) {
          const double area =
              areaAt(patches.patch(cell.piece), side * cell.column, side * cell.row, side, random);
          EXPECT_LE(area, cell.bound);
          EXPECT_GE(area, cell.least);
        }
        continue;
      }
      RingPitches pitches(patches, cell.piece);
      CoreTail tail(pitches, cell.piece.steps,
                    Vector3(cell.outer[0], cell.outer[1], cell.outer[2]));
      double sum = 0;
      for (int step = 1; step < 20 && !tail.ended(); ++step, tail.step()) {
        for (std::int16_t quarter = 0; quarter < 3; ++quarter) {
          const SurfacePiece piece = {cell.piece.tile, static_cast<std::int16_t>(tail.steps() + 1),
                                      quarter};
          for (int i = 0; i < 4; ++i) {
            EXPECT_LE(areaAt(patches.patch(piece), 0, 0, 1, random), tail.bound())
                << "after " << tail.steps() << " steps";
          }
          sum += tail.bound();
        }
      }
      EXPECT_LE(sum, cell.bound);
    }
  }
}

TEST(AreaCells, AreFewAndTight) {
  const auto expectFew = [](const Cage& cage, double most, double share) {
    const LimitSurface surface = limitSurface(cage);
    const SurfacePatches patches(surface, 0, PatchUnit::own);
    const std::vector<AreaCell> cells = areaCells(patches, 0);
    EXPECT_LE(static_cast<double>(cells.size()), most * static_cast<double>(cage.faces.size()));
    double area = 0, bound = 0, least = 0;
    for (const AreaCell& cell : cells) {
      area += cell.area;
      bound += cell.bound;
      least += cell.least;
    }
    EXPECT_LE(bound, 1.4 * area);
    EXPECT_GE(least, share * area);
    // The first radius of blue noise by count is chosen by this estimate.
    const double truth = surfaceArea(surface) * patches.scale() * patches.scale();
    EXPECT_NEAR(area, truth, 0.005 * truth);
  };
  const Cage quads = perturbed(grid(20, 20), 0.1, 7);
  expectFew(quads, 1.1, 0.7);
  expectFew(halved(quads), 64, 0.3);  // in 12 tiles
  expectFew(pole(512), 96, 0);
}

TEST(AreaCells, HaveTheSameBitsWithAllInstructionSets) {
  const InstructionSet before = instructionSet();
  const LimitSurface surface = limitSurface(perturbed(halved(grid(6, 6)), 0.2, 1));
  const SurfacePatches patches(surface, 0, PatchUnit::own);
  useInstructionSet(InstructionSet::baseline);
  const std::vector<AreaCell> cells = areaCells(patches, 0);
  const std::vector<Location> noise = AreaSampler(surface).blueNoise({500, {}, 3, {}}).at;
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!isAvailable(set)) continue;
    useInstructionSet(set);
    const std::vector<AreaCell> same = areaCells(patches, 0);
    ASSERT_EQ(same.size(), cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      EXPECT_EQ(same[i].bound, cells[i].bound);
      EXPECT_EQ(same[i].least, cells[i].least);
      EXPECT_EQ(same[i].area, cells[i].area);
    }
    const std::vector<Location> same_noise = AreaSampler(surface).blueNoise({500, {}, 3, {}}).at;
    ASSERT_EQ(same_noise.size(), noise.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
      EXPECT_EQ(same_noise[i].u, noise[i].u);
      EXPECT_EQ(same_noise[i].v, noise[i].v);
    }
  }
  useInstructionSet(before);
}

}  // namespace
}  // namespace limitsurf::test
