// SPDX-License-Identifier: Apache-2.0
#include "bench/uv/uv_benchmarks.h"

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/support/mesh_arrays.h"
#include "bench/support/process_cost.h"
#include "limitsurf/uv/uv_map.h"
#include "support/cages/benchmark_cages.h"
#include "support/cages/meshes.h"
#include "support/random.h"

namespace limitsurf::bench {
namespace {

constexpr int kRepetitions = 3;
constexpr int kPeerSide = 16;  // squares a side of a Ptex face: level 4
constexpr int kLookups = 1000000;

struct Time {
  double wall, cpu;
};

/// The median of a few runs; cpu is that of all threads.
Time timeOf(const std::function<void()>& work) {
  std::vector<Time> times;
  for (int i = 0; i < kRepetitions; ++i) {
    const double cpu = cpuSeconds();
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
         cpuSeconds() - cpu});
  }
  std::sort(times.begin(), times.end(), [](const Time& a, const Time& b) { return a.cpu < b.cpu; });
  return times[kRepetitions / 2];
}

struct MapCase {
  std::string name;
  LimitSurface surface;
  SurfaceData map;
};

std::vector<std::int64_t> corners(const MeshArrays& cage) { return cage.face_vertices; }

/// A map that projects the cage from above: one island that fills most of the image.
MapCase whole(const std::string& name, const MeshArrays& cage, Interpolation interpolation) {
  DataRows values = cage.positions.leftCols(2);
  const Eigen::RowVector2d low = values.colwise().minCoeff(), high = values.colwise().maxCoeff();
  values = (values.rowwise() - low).array().rowwise() / (high - low).array();
  values = 0.001 + 0.998 * values.array();
  LimitSurface surface(cage.controlMesh());
  SurfaceData map = surface.faceVarying(values, corners(cage), interpolation);
  return {name, std::move(surface), std::move(map)};
}

/// A map on which every face is an island of its own, all of the same size, with gaps between them.
MapCase islands(const std::string& name, const MeshArrays& cage) {
  const int side = static_cast<int>(std::ceil(std::sqrt(cage.faceCount())));
  DataRows values(4 * cage.faceCount(), 2);
  std::vector<std::int64_t> rows;
  for (int face = 0; face < cage.faceCount(); ++face) {
    const double x = face % side, y = face / side;
    values.row(4 * face) << x + 0.1, y + 0.1;
    values.row(4 * face + 1) << x + 0.9, y + 0.1;
    values.row(4 * face + 2) << x + 0.9, y + 0.9;
    values.row(4 * face + 3) << x + 0.1, y + 0.9;
  }
  values /= side;
  for (int row = 0; row < 4 * cage.faceCount(); ++row) rows.push_back(row);
  LimitSurface surface(cage.controlMesh());
  SurfaceData map = surface.faceVarying(values, rows, Interpolation::boundaries);
  return {name, std::move(surface), std::move(map)};
}

/// The usual method: triangles between exact points of the map, with linear coordinates in each.
class TriangleRaster {
 public:
  struct Texel {
    float u, v;
    int face = -1;
  };

  TriangleRaster(const SurfaceData& map, int side)
      : side_(side), texels_(static_cast<std::size_t>(side) * side) {
    std::vector<Location> at;
    for (int j = 0; j <= kPeerSide; ++j) {
      for (int i = 0; i <= kPeerSide; ++i) {
        at.push_back({0, static_cast<double>(i) / kPeerSide, static_cast<double>(j) / kPeerSide});
      }
    }
    for (int face = 0; face < map.faceCount(); ++face) {
      for (Location& location : at) location.face = face;
      const DataRows points = side * map.evaluate(at, Derivatives::none, 1).value.array() - 0.5;
      for (int j = 0; j < kPeerSide; ++j) {
        for (int i = 0; i < kPeerSide; ++i) {
          const int a = j * (kPeerSide + 1) + i, c = a + kPeerSide + 2;
          add(points, at, a, a + 1, c);
          add(points, at, a, c, c - 1);
        }
      }
    }
  }

  const Texel& at(int x, int y) const { return texels_[static_cast<std::size_t>(y) * side_ + x]; }

 private:
  void add(const DataRows& points, const std::vector<Location>& at, int a, int b, int c) {
    const Eigen::RowVector2d origin = points.row(a), ab = points.row(b) - points.row(a),
                             ac = points.row(c) - points.row(a);
    const double area = ab[0] * ac[1] - ab[1] * ac[0];
    const auto bounds = [&](int axis, int& first, int& last) {
      const double low = std::min({0., ab[axis], ac[axis]}) + origin[axis],
                   high = std::max({0., ab[axis], ac[axis]}) + origin[axis];
      first = std::max(0, static_cast<int>(std::ceil(low)));
      last = std::min(side_ - 1, static_cast<int>(std::floor(high)));
    };
    int x0, x1, y0, y1;
    bounds(0, x0, x1);
    bounds(1, y0, y1);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double dx = x - origin[0], dy = y - origin[1];
        const double p = (dx * ac[1] - dy * ac[0]) / area, q = (ab[0] * dy - ab[1] * dx) / area;
        if (p >= 0 && q >= 0 && p + q <= 1) {
          Texel& texel = texels_[static_cast<std::size_t>(y) * side_ + x];
          texel.face = at[a].face;
          texel.u = static_cast<float>(at[a].u + p * (at[b].u - at[a].u) + q * (at[c].u - at[a].u));
          texel.v = static_cast<float>(at[a].v + p * (at[b].v - at[a].v) + q * (at[c].v - at[a].v));
        }
      }
    }
  }

  int side_;
  std::vector<Texel> texels_;
};

/// The largest distances, in texels, between the centres of texels and the values of the map at
/// their locations.
struct Errors {
  double ours = 0, peer = 0;
  long missed = 0,
       beyond = 0;  ///< the numbers of texels that only limitsurf has, and only the peer
};

Errors errorsOf(const SurfaceData& map, int side, const Texels& texels,
                const TriangleRaster& peer) {
  Errors errors;
  const auto error = [&](int x, int y, const Location& at) {
    const DataRows value = map.evaluate(Span<Location>(&at, 1), Derivatives::none, 1).value;
    return std::hypot(value(0, 0) * side - 0.5 - x, value(0, 1) * side - 0.5 - y);
  };
  std::vector<bool> covered(static_cast<std::size_t>(side) * side, false);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const int x = texels.x[i], y = texels.y[i];
    covered[static_cast<std::size_t>(y) * side + x] = true;
    errors.missed += peer.at(x, y).face < 0;
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      errors.beyond += peer.at(x, y).face >= 0 && !covered[static_cast<std::size_t>(y) * side + x];
    }
  }
  for (std::size_t i = 0; i < texels.size(); i += 37) {
    const int x = texels.x[i], y = texels.y[i];
    errors.ours =
        std::max(errors.ours, error(x, y, {texels.face[i], texels.uv[i][0], texels.uv[i][1]}));
    const TriangleRaster::Texel& other = peer.at(x, y);
    if (other.face >= 0) {
      errors.peer = std::max(errors.peer, error(x, y, {other.face, other.u, other.v}));
    }
  }
  return errors;
}

void measure(const MapCase& of, int side) {
  RasterOptions options;
  options.width = options.height = side;
  const Time making = timeOf([&] { const UvMap map(of.map); });
  const UvMap map(of.map);
  Texels texels;
  const Time raster = timeOf([&] {
    texels = {};
    texels = map.rasterize(options);
  });
  options.margin = 16;
  const Time margin = timeOf([&] { map.rasterize(options); });
  std::unique_ptr<TriangleRaster> peer;
  const Time triangles = timeOf([&] {
    peer = nullptr;
    peer = std::make_unique<TriangleRaster>(of.map, side);
  });
  test::BenchmarkRandom random(1);
  PlanePoints points(kLookups, 2);
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    points.row(row) << random.uniform(), random.uniform();
  const Time locating = timeOf([&] { map.locate(points); });
  const Errors errors = errorsOf(of.map, side, texels, *peer);
  std::printf(
      "| %s | %d | %.1f | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) | (%.2f) | %.1g | "
      "%.1g | %ld / %ld |\n",
      of.name.c_str(), side, static_cast<double>(texels.size()) * 1e-6, making.wall, making.cpu,
      raster.wall, raster.cpu, margin.wall, margin.cpu, locating.wall, locating.cpu, triangles.cpu,
      errors.ours, errors.peer, errors.missed, errors.beyond);
}

}  // namespace

int measureUvMaps(int side) {
  std::printf(
      "UV maps on %d cores, seconds (of all cores together); medians of %d.\n\n"
      "| map | image | covered, millions | set-up | rasterize | with margin 16 | locate, a million "
      "| triangles | error | of triangles | texels they miss / have too many |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
      tbb::info::default_concurrency(), kRepetitions);
  measure(whole("10,000 faces, one island, smooth", test::largeCage(100), Interpolation::none),
          side);
  measure(whole("the same, linear", test::largeCage(100), Interpolation::all), side);
  measure(islands("10,000 islands", test::largeCage(100)), side);
  measure(whole("one quad", test::grid(1, 1), Interpolation::boundaries), side);
  measure(whole("1,000,000 faces", test::largeCage(1000), Interpolation::none), side / 4);
  return 0;
}

}  // namespace limitsurf::bench
