// SPDX-License-Identifier: Apache-2.0
//
// Work whose instructions tools/instruction_counts.py counts under callgrind.
//
//   limitsurf_instructions                 lists the kinds of work
//   limitsurf_instructions KIND SIZE       does it once, on one thread, for so many rows or faces
//
// Instructions for vectors that not every processor has are not used, so that the counts are the
// same on all of them.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/surface/batch/instruction_sets.h"
#include "limitsurf/surface/limit_surface.h"
#include "support/cages/benchmark_cages.h"
#include "support/cages/meshes.h"
#include "support/cages/strange_meshes.h"
#include "support/random.h"

namespace limitsurf::test {
namespace {

/// So many locations, in the order of the faces.
std::vector<Location> sorted(const LimitSurface& surface, int count) {
  Random random(1);
  std::vector<Location> at;
  for (int i = 0; i < count; ++i) {
    const int face = static_cast<int>(std::int64_t{i} * surface.faceCount() / count);
    at.push_back({face, random.uniform(), random.uniform()});
  }
  return at;
}

std::vector<Location> shuffled(const LimitSurface& surface, int count) {
  std::vector<Location> at = sorted(surface, count);
  Random(2).shuffle(at);
  return at;
}

/// Locations 2^-5 to 2^-12 from the vertex (0, 0) of the first face.
std::vector<Location> nearVertex(int count) {
  Random random(3);
  std::vector<Location> at;
  for (int i = 0; i < count; ++i) {
    const double size = std::ldexp(1, -5 - random.below(8));
    at.push_back({0, size * random.uniform(0.5, 1), size * random.uniform()});
  }
  return at;
}

/// Points near a surface.
Points pointsNear(const LimitSurface& surface, int count) {
  Random random(4);
  Points points = surface.evaluate(shuffled(surface, count), Derivatives::none, false, 1).position;
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    points.row(row) += random.vector(0.3);
  }
  return points;
}

/// A pole whose edges have all their own sharpness.
Cage creasedPole(int triangles) {
  Cage cage = pole(triangles);
  cage.options.creasing = Creasing::chaikin;
  Random random(5);
  for (int i = 1; i <= triangles; ++i) {
    cage.options.edge_sharpness.edges.push_back({0, i});
    cage.options.edge_sharpness.values.push_back(random.uniform(0, 3));
  }
  return cage;
}

/// The pole's vertex is moved up, so that all faces are slender and close together there.
Cage slenderCone(int triangles) {
  Cage cage = pole(triangles);
  cage.positions(0, 2) += 100;
  return cage;
}

/// Faces a hundred times as long as wide, in a direction between the axes.
Cage slenderSheet() {
  Cage cage = perturbed(grid(20, 20), 0.1, 1);
  const Eigen::RowVector3d along = Eigen::RowVector3d(1, 2, 3).normalized();
  for (auto position : cage.positions.rowwise()) {
    position += 99 * position.dot(along) * along;
  }
  return cage;
}

LimitSurface regular() { return limitSurface(perturbed(grid(20, 20), 0.1, 1)); }

struct Work {
  const char* name;
  void (*run)(int size);
};

constexpr Work kWork[] = {
    {"evaluate P,D1, regular, sorted",
     [](int n) {
       const LimitSurface surface = regular();
       surface.evaluate(sorted(surface, n), Derivatives::first, false, 1);
     }},
    {"evaluate P,D1, regular, shuffled",
     [](int n) {
       const LimitSurface surface = regular();
       surface.evaluate(shuffled(surface, n), Derivatives::first, false, 1);
     }},
    {"evaluate P,D1,D2, regular, sorted",
     [](int n) {
       const LimitSurface surface = regular();
       surface.evaluate(sorted(surface, n), Derivatives::second, false, 1);
     }},
    {"evaluate P,D1, several irregular vertices, sorted",
     [](int n) {
       const LimitSurface surface = limitSurface(cross());
       surface.evaluate(sorted(surface, n), Derivatives::first, false, 1);
     }},
    {"evaluate P,D1, near an irregular vertex",
     [](int n) {
       const LimitSurface surface = limitSurface(fan(5, true, 1));
       surface.evaluate(nearVertex(n), Derivatives::first, false, 1);
     }},
    {"frames, regular, shuffled",
     [](int n) {
       const LimitSurface surface = regular();
       surface.frames(shuffled(surface, n), 1);
     }},
    {"frames, at irregular vertices",
     [](int n) {
       const LimitSurface surface = limitSurface(fan(5, true, 1));
       surface.frames(std::vector<Location>(static_cast<std::size_t>(n), {0, 0, 0}), 1);
     }},
    {"closest, near",
     [](int n) {
       const LimitSurface surface = regular();
       SurfaceSearch(surface, 1).closest(pointsNear(surface, n), {}, 1);
     }},
    {"first hits of rays, slender faces aslant",
     [](int n) {
       const LimitSurface surface = limitSurface(slenderSheet());
       Points origins(n, 3), directions(n, 3);
       Random random(6);
       for (int row = 0; row < n; ++row) {
         directions.row(row) = random.vector(1).transpose();
         origins.row(row) = surface.positions().row(row % surface.positions().rows());
         origins.row(row) -= 100 * directions.row(row);
       }
       SurfaceSearch(surface, 1).rayCast(origins, directions, 1000, 1);
     }},
    {"uniform points",
     [](int n) {
       const LimitSurface surface = regular();
       AreaSampler(surface, 1).uniform(n, 1, {}, 1);
     }},
    {"blue noise, one point a triangle",
     [](int n) {
       // About n / 10 triangles.
       const LimitSurface surface = limitSurface(scanCage(static_cast<int>(std::sqrt(n / 20))));
       BlueNoiseOptions options;
       options.count = n / 10;
       AreaSampler(surface, 1).blueNoise(options, 1);
     }},
    {"blue noise, a slender cone",
     [](int n) {
       const LimitSurface surface = limitSurface(slenderCone(n / 40));
       BlueNoiseOptions options;
       options.count = 50;
       AreaSampler(surface, 1).blueNoise(options, 1);
     }},
    {"open, a pole with semi-sharp edges", [](int n) { limitSurface(creasedPole(n)); }},
    {"open, faces on one edge", [](int n) { limitSurface(book(n)); }},
    {"pose, irregular",
     [](int n) {
       LimitSurface surface = limitSurface(mixture(3));
       for (int i = 0; i < n / 100; ++i) {
         surface.setPositions(surface.positions(), 1);
       }
     }},
    {"area, triangles and quads",
     [](int n) {
       const LimitSurface surface = limitSurface(mixture(3));
       for (int i = 0; i < n / 100; ++i) {
         surfaceArea(surface, 1);
       }
     }},
};

int run(int argc, char** argv) {
  if (argc != 3) {
    for (const Work& work : kWork) std::printf("%s\n", work.name);
    return argc == 1 ? 0 : 2;
  }
  useInstructionSet(InstructionSet::baseline);
  for (const Work& work : kWork) {
    if (std::strcmp(work.name, argv[1]) == 0) {
      work.run(std::atoi(argv[2]));
      return 0;
    }
  }
  std::fprintf(stderr, "no work is called %s\n", argv[1]);
  return 2;
}

}  // namespace
}  // namespace limitsurf::test

int main(int argc, char** argv) {
  try {
    return limitsurf::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
