// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/jittered_sampling.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "limitsurf/error.h"
#include "limitsurf/interruptible_vector.h"
#include "limitsurf/parallel.h"
#include "limitsurf/random_bits.h"

namespace limitsurf {
namespace {

/// More locations than this fit into no machine's memory.
constexpr std::size_t kMostLocations = std::size_t{1} << 40;
constexpr std::size_t kLocationsPerTask = 8192;

}  // namespace

std::vector<Location> scatterJittered(const LimitSurface& surface, int per_side, std::uint64_t seed,
                                      int threads) {
  std::vector<std::int64_t> faces(static_cast<std::size_t>(surface.faceCount()));
  std::iota(faces.begin(), faces.end(), 0);
  return scatterJittered(surface, faces, per_side, seed, threads);
}

std::vector<Location> scatterJittered(const LimitSurface& surface, Span<std::int64_t> wanted,
                                      int per_side, std::uint64_t seed, int threads) {
  checkThreads(threads);
  if (per_side < 1) {
    throw std::invalid_argument("per_side is " + std::to_string(per_side) +
                                "; it must be at least 1");
  }
  std::vector<int> faces;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::int64_t face = wanted[i];
    if (face < 0 || face >= surface.faceCount()) {
      throw LocationError("faces[" + std::to_string(i) + "] is " + std::to_string(face) +
                          "; the surface has " + std::to_string(surface.faceCount()) +
                          " Ptex faces");
    }
    if (!surface.refused().count(surface.baseFace()[static_cast<std::size_t>(face)])) {
      faces.push_back(static_cast<int>(face));
    }
  }
  const std::size_t side = static_cast<std::size_t>(per_side), per_face = side * side;
  if (!faces.empty() && per_face > kMostLocations / faces.size()) {
    throw std::invalid_argument("per_side is " + std::to_string(per_side) + " on " +
                                std::to_string(faces.size()) + " faces; the limit is " +
                                std::to_string(kMostLocations) + " locations");
  }
  std::vector<Location> result;
  resizeInParts(result, faces.size() * per_face);
  const std::uint64_t key = keyOf(seed);
  parallelFor(result.size(), kLocationsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t stratum = i % per_face, column = stratum % side, row = stratum / side;
      const int face = faces[i / per_face];
      const std::uint64_t number = static_cast<std::uint64_t>(face) * per_face + stratum;
      const std::uint64_t bits = mixed(key ^ mixed(number));
      const double u = (static_cast<double>(column) + uniformIn01(bits)) / per_side;
      const double v = (static_cast<double>(row) + uniformIn01(mixed(bits))) / per_side;
      result[i] = {face, std::min(u, 1.), std::min(v, 1.)};
    }
  });
  return result;
}

}  // namespace limitsurf
