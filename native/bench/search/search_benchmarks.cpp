// SPDX-License-Identifier: Apache-2.0
#include "bench/search/search_benchmarks.h"

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/support/embree_peer.h"
#include "bench/support/median.h"
#include "bench/support/mesh_arrays.h"
#include "bench/support/numpy_file.h"
#include "bench/support/process_cost.h"
#include "limitsurf/pi.h"
#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/search/surface_search.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/benchmark_cages.h"
#include "support/random.h"

namespace limitsurf::bench {
namespace {

constexpr int kSide = 100;
constexpr int kPeerLevel = 4;
constexpr int kRepetitions = 3;

struct Seconds {
  std::vector<double> wall, cpu;  ///< one for each repetition; cpu is that of all threads

  void measure(const std::function<void()>& work) {
    const double cpu_before = cpuSeconds();
    const auto start = std::chrono::steady_clock::now();
    work();
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    cpu.push_back(cpuSeconds() - cpu_before);
  }
};

/// Prints a row for each structure that is made before the first search.
bool measureSetUp(const MeshArrays& cage) {
  std::unique_ptr<LimitSurface> surface;
  Tessellation mesh;
  const auto with_surface = [&] { surface = std::make_unique<LimitSurface>(cage.controlMesh()); };
  const auto with_mesh = [&] {
    with_surface();
    mesh = tessellate(*surface, kPeerLevel);
  };
  struct Row {
    const char* name;
    Opening open;
    std::function<void()> prepare;
  };
  const Row rows[] = {
      {"limitsurf SurfaceSearch", [&] { return std::make_shared<SurfaceSearch>(*surface); },
       with_surface},
      {"limitsurf AreaSampler", [&] { return std::make_shared<AreaSampler>(*surface); },
       with_surface},
      {"tessellate(4)",
       [&] { return std::make_shared<Tessellation>(tessellate(*surface, kPeerLevel)); },
       with_surface},
      {"Embree over its triangles", [&] { return std::make_shared<EmbreePeer>(mesh); }, with_mesh},
  };
  std::printf("| set-up | s | peak MiB | kept MiB |\n|---|---:|---:|---:|\n");
  for (const Row& row : rows) {
    std::vector<Cost> costs(kRepetitions);
    for (Cost& cost : costs) {
      if (!measureApart(row.open, cost, row.prepare)) {
        std::fprintf(stderr, "%s failed\n", row.name);
        return false;
      }
    }
    std::sort(costs.begin(), costs.end(),
              [](const Cost& a, const Cost& b) { return a.seconds < b.seconds; });
    const Cost& middle = costs[kRepetitions / 2];
    std::printf("| %s | %.3f | %.0f | %.0f |\n", row.name, middle.seconds, middle.peak_mib,
                middle.kept_mib);
  }
  return true;
}

struct Queries {
  const char* name;
  const char* file_name;
  Points origins;
  Points directions;  ///< those of rays, of length 1; no rows for closest points
};

Vector3 randomDirection(test::BenchmarkRandom& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(-kPi<double>, kPi<double>);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Points at a random distance from the surface, `reach` at most.
Queries pointsNear(const char* name, const char* file_name, const Points& on_surface,
                   double reach) {
  test::BenchmarkRandom random(1);
  Queries queries{name, file_name, on_surface, {}};
  for (Eigen::Index i = 0; i < on_surface.rows(); ++i) {
    const double distance = random.uniform(0, reach);
    queries.origins.row(i) += distance * randomDirection(random).transpose();
  }
  return queries;
}

/// Rays towards places of the surface; a ray may meet other places before.
Queries raysTo(const char* name, const char* file_name, const Points& on_surface, double distance,
               const std::function<Vector3(test::BenchmarkRandom&)>& direction) {
  test::BenchmarkRandom random(2);
  Queries queries{name, file_name, on_surface, Points(on_surface.rows(), 3)};
  for (Eigen::Index i = 0; i < on_surface.rows(); ++i) {
    queries.directions.row(i) = direction(random).transpose();
    queries.origins.row(i) -= distance * queries.directions.row(i);
  }
  return queries;
}

/// The queries of each row of the table.
std::vector<Queries> allQueries(const MeshArrays& cage, const LimitSurface& surface,
                                const AreaSampler& sampler, int count) {
  const double diagonal = cage.diagonal();
  const double face_width = std::sqrt(surfaceArea(surface) / cage.faceCount());
  const Points on_surface = surface.evaluate(sampler.uniform(count, 1)).position;
  const auto down = [](test::BenchmarkRandom&) { return Vector3(0, 0, -1); };
  return {pointsNear("closest, to 5 % of the diagonal", "closest-far", on_surface, 0.05 * diagonal),
          pointsNear("closest, to 5 % of a face's width", "closest-near", on_surface,
                     0.05 * face_width),
          raysTo("rays, from above", "rays-above", on_surface, diagonal, down),
          raysTo("rays, from all sides", "rays-all-sides", on_surface, diagonal, randomDirection)};
}

struct Errors {
  double max = 0, rms = 0;
};

Errors errorsOf(const Eigen::VectorXd& differences, double diagonal) {
  return {
      differences.maxCoeff() / diagonal,
      std::sqrt(differences.squaredNorm() / static_cast<double>(differences.size())) / diagonal};
}

void compare(const Queries& queries, const SurfaceSearch& search, const EmbreePeer& peer,
             double diagonal) {
  const bool are_rays = queries.directions.rows() > 0;
  Hits ours;
  EmbreePeer::Found theirs;
  Seconds our_seconds, their_seconds;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    our_seconds.measure([&] {
      ours = are_rays ? search.rayCast(queries.origins, queries.directions)
                      : search.closest(queries.origins);
    });
    their_seconds.measure([&] {
      theirs = are_rays ? peer.rayCast(queries.origins, queries.directions)
                        : peer.closest(queries.origins);
    });
  }

  Eigen::VectorXd moved = Eigen::VectorXd::Zero(queries.origins.rows());
  Eigen::VectorXd farther = moved;
  int missed = 0, invented = 0;
  for (Eigen::Index i = 0; i < queries.origins.rows(); ++i) {
    const bool is_ours = ours.at[static_cast<std::size_t>(i)].face >= 0;
    const bool is_theirs = !std::isnan(theirs.distance[i]);
    missed += is_ours && !is_theirs;
    invented += is_theirs && !is_ours;
    if (!is_ours || !is_theirs) continue;
    moved[i] = (ours.position.row(i) - theirs.position.row(i)).norm();
    farther[i] = std::abs(ours.distance[i] - theirs.distance[i]);
  }
  const Errors position = errorsOf(moved, diagonal), distance = errorsOf(farther, diagonal);
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.1e | %.1e | %.1e | %.1e | %d | %d |\n",
              queries.name, median(our_seconds.wall), median(our_seconds.cpu),
              median(their_seconds.wall), median(their_seconds.cpu),
              median(their_seconds.cpu) / median(our_seconds.cpu), distance.max, distance.rms,
              position.max, position.rms, missed, invented);
  std::fflush(stdout);
}

void timeScattering(const AreaSampler& sampler, int count, double area) {
  std::printf("\n| random points | s | CPU s |\n|---|---:|---:|\n");
  const auto row = [](const char* name, const std::function<void()>& work) {
    Seconds seconds;
    for (int repetition = 0; repetition < kRepetitions; ++repetition) seconds.measure(work);
    std::printf("| %s | %.2f | %.2f |\n", name, median(seconds.wall), median(seconds.cpu));
    std::fflush(stdout);
  };
  row("uniform", [&] { sampler.uniform(count, 1); });
  BlueNoiseOptions options;
  options.radius = std::sqrt(0.7 * area / count);
  row("blue noise, by radius", [&] { sampler.blueNoise(options); });
  options.radius.reset();
  options.count = count;
  row("blue noise, by count", [&] { sampler.blueNoise(options); });
}

}  // namespace

int measureSearches(int count) {
  const MeshArrays cage = test::largeCage(kSide);
  const double diagonal = cage.diagonal();
  std::printf("%d quads, open; all threads; median of %d\n\n", cage.faceCount(), kRepetitions);
  if (!measureSetUp(cage)) return 1;

  std::printf("\n%d threads, %d each\n\n", tbb::info::default_concurrency(), count);
  std::fflush(stdout);
  const LimitSurface surface(cage.controlMesh());
  const SurfaceSearch search(surface);
  const AreaSampler sampler(surface);
  const EmbreePeer peer(tessellate(surface, kPeerLevel));
  std::printf(
      "| | limitsurf s | CPU s | Embree s | CPU s | Embree / ours | its distance: max | RMS | its "
      "position: max | "
      "RMS | missed | invented |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const Queries& queries : allQueries(cage, surface, sampler, count)) {
    compare(queries, search, peer, diagonal);
  }
  timeScattering(sampler, count, surfaceArea(surface));
  return 0;
}

void saveSearches(const std::string& folder, int count) {
  const MeshArrays cage = test::largeCage(kSide);
  const LimitSurface surface(cage.controlMesh());
  for (const Queries& queries : allQueries(cage, surface, AreaSampler(surface), count)) {
    const std::string path = folder + "/" + queries.file_name;
    cage.save(path);
    writeNumpy(path + ".origins.npy", queries.origins);
    writeNumpy(path + ".directions.npy", queries.directions);
  }
}

}  // namespace limitsurf::bench
