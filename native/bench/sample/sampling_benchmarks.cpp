// SPDX-License-Identifier: Apache-2.0
#include "bench/sample/sampling_benchmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>

#include "bench/support/mesh_arrays.h"
#include "limitsurf/sample/area.h"
#include "limitsurf/sample/area_sampler.h"
#include "limitsurf/tessellate/tessellation.h"
#include "support/cages/benchmark_cages.h"
#include "support/random.h"

namespace limitsurf::bench {
namespace {

constexpr int kPeerLevel = 4;

struct ScatterCage {
  explicit ScatterCage(MeshArrays made)
      : cage(std::move(made)), surface(cage.controlMesh()), sampler(surface) {}
  /// The radius of that much blue noise.
  double radius(int count) const { return std::sqrt(0.7 * surfaceArea(surface) / count); }

  MeshArrays cage;
  LimitSurface surface;
  AreaSampler sampler;
};

/// Uniform points on triangles by the usual method: a triangle by area, then barycentric
/// coordinates.
class TriangleSampler {
 public:
  explicit TriangleSampler(const LimitSurface& surface)
      : mesh_(tessellate(surface, kPeerLevel, TessellationOptions{1})) {
    double sum = 0;
    for (std::size_t quad = 0; quad < mesh_.face_vertices.size() / 4; ++quad) {
      for (const int half : {0, 1}) {
        const Vector3 a = corner(quad, 0), b = corner(quad, 1 + half), c = corner(quad, 2 + half);
        sums_.push_back(sum += (b - a).cross(c - a).norm());
      }
    }
  }

  Vector3 point(test::BenchmarkRandom& random) const {
    const double at = sums_.back() * random.uniform();
    const std::size_t triangle =
        static_cast<std::size_t>(std::lower_bound(sums_.begin(), sums_.end(), at) - sums_.begin());
    const std::size_t quad = triangle / 2, half = triangle % 2;
    const double root = std::sqrt(random.uniform()), part = random.uniform();
    return (1 - root) * corner(quad, 0) + root * (1 - part) * corner(quad, 1 + half) +
           root * part * corner(quad, 2 + half);
  }

 private:
  Vector3 corner(std::size_t quad, std::size_t i) const {
    return mesh_.positions.row(mesh_.face_vertices[4 * quad + i]);
  }

  Tessellation mesh_;
  std::vector<double> sums_;
};

/// The number of points that a sieve keeps, which takes one after the other unless it is within
/// `radius` of a point kept before.
std::size_t sieved(const Points& points, double radius) {
  std::unordered_map<std::int64_t, std::vector<Eigen::Index>> cubes;
  std::size_t kept = 0;
  const auto index = [&](Eigen::Index i, int axis) {
    return static_cast<std::int64_t>(std::floor(points(i, axis) / radius)) + (1 << 20);
  };
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const auto cube = [&](int dx, int dy, int dz) {
      return ((index(i, 0) + dx) << 42) | ((index(i, 1) + dy) << 21) | (index(i, 2) + dz);
    };
    bool is_free = true;
    for (int n = 0; n < 27 && is_free; ++n) {
      const auto found = cubes.find(cube(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      if (found == cubes.end()) continue;
      is_free = std::all_of(found->second.begin(), found->second.end(), [&](Eigen::Index other) {
        return (points.row(other) - points.row(i)).squaredNorm() >= radius * radius;
      });
    }
    if (is_free) {
      cubes[cube(0, 0, 0)].push_back(i);
      ++kept;
    }
  }
  return kept;
}

using Shared = std::shared_ptr<const ScatterCage>;

Group setupGroup(const std::string& row, const Shared& cage) {
  Group group{kSamplerSetupTable, row, {}};
  group.columns.push_back({"limitsurf", [=](benchmark::State& state) {
                             for (auto _ : state) {
                               const AreaSampler sampler(cage->surface, 1);
                               benchmark::DoNotOptimize(sampler);
                             }
                             countItems(state, cage->cage.ptexFaceCount());
                           }});
  group.columns.push_back({"triangles", [=](benchmark::State& state) {
                             for (auto _ : state) {
                               const TriangleSampler sampler(cage->surface);
                               benchmark::DoNotOptimize(sampler);
                             }
                             countItems(state, cage->cage.ptexFaceCount());
                           }});
  return group;
}

Group uniformGroup(const std::string& row, const Shared& cage, int count) {
  Group group{kUniformTable, row, {}};
  group.columns.push_back({"limitsurf", [=](benchmark::State& state) {
                             for (auto _ : state) {
                               const auto at = cage->sampler.uniform(count, 1, {}, 1);
                               benchmark::DoNotOptimize(at.data());
                             }
                             countItems(state, static_cast<std::size_t>(count));
                           }});
  group.columns.push_back({"their positions",
                           [=](benchmark::State& state) {
                             const auto at = cage->sampler.uniform(count, 1, {}, 1);
                             for (auto _ : state) {
                               const Evaluation all =
                                   cage->surface.evaluate(at, Derivatives::none, false, 1);
                               benchmark::DoNotOptimize(all.position.data());
                             }
                             countItems(state, at.size());
                           },
                           false});
  group.columns.push_back({"triangles", [=](benchmark::State& state) {
                             const TriangleSampler triangles(cage->surface);
                             test::BenchmarkRandom random(1);
                             Points points(count, 3);
                             for (auto _ : state) {
                               for (Eigen::Index i = 0; i < points.rows(); ++i) {
                                 points.row(i) = triangles.point(random);
                               }
                               benchmark::DoNotOptimize(points.data());
                             }
                             countItems(state, static_cast<std::size_t>(count));
                           }});
  return group;
}

Group blueNoiseGroup(const std::string& row, const Shared& cage, int count) {
  Group group{kBlueNoiseTable, row, {}};
  const auto run = [=](benchmark::State& state, const BlueNoiseOptions& options) {
    std::size_t points = 0;
    for (auto _ : state) points = cage->sampler.blueNoise(options, 1).at.size();
    countItems(state, points);
  };
  group.columns.push_back({"by radius", [=](benchmark::State& state) {
                             BlueNoiseOptions options;
                             options.radius = cage->radius(count);
                             run(state, options);
                           }});
  group.columns.push_back({"by count",
                           [=](benchmark::State& state) {
                             BlueNoiseOptions options;
                             options.count = count;
                             run(state, options);
                           },
                           false});
  group.columns.push_back({"sieve of 8",
                           [=](benchmark::State& state) {
                             std::size_t kept = 0;
                             for (auto _ : state) {
                               const auto at = cage->sampler.uniform(8 * count, 1, {}, 1);
                               kept = sieved(
                                   cage->surface.evaluate(at, Derivatives::none, false, 1).position,
                                   cage->radius(count));
                             }
                             countItems(state, kept);
                           },
                           false});
  return group;
}

}  // namespace

std::vector<Group> samplingGroups(int count) {
  std::vector<Group> groups;
  const std::pair<std::string, MeshArrays> cages[] = {{"mixed-10k-faces", test::largeCage(100)},
                                                      {"every class", test::everyClassCage()},
                                                      {"multi-EV", test::crossesCage()},
                                                      {"non-quad", test::polygonsCage()}};
  for (const auto& [name, cage] : cages) {
    const auto shared = std::make_shared<const ScatterCage>(cage);
    const std::string row = name + "/" + std::to_string(cage.ptexFaceCount());
    groups.push_back(setupGroup(row, shared));
    groups.push_back(uniformGroup(row, shared, count));
    groups.push_back(blueNoiseGroup(row, shared, count));
  }
  return groups;
}

}  // namespace limitsurf::bench
