// SPDX-License-Identifier: Apache-2.0
#include "bench/support/location_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/random.h"

namespace limitsurf::bench {
namespace {

constexpr std::uint64_t kSeed = 20070805;

int perFace(const std::vector<int>& faces, int count) {
  return std::max(1, count / static_cast<int>(faces.size()));
}

}  // namespace

std::vector<Location> uniformSamples(const std::vector<int>& faces, int count) {
  test::BenchmarkRandom random(kSeed);
  std::vector<Location> samples;
  for (const int face : faces) {
    for (int k = perFace(faces, count); k > 0; --k) {
      const double u = random.uniform(), v = random.uniform();
      samples.push_back({face, u, v});
    }
  }
  return samples;
}

std::vector<Location> samplesNearEvs(const std::vector<ClassifiedFace>& classified,
                                     const std::vector<int>& faces, int count,
                                     Distances distances) {
  test::BenchmarkRandom random(kSeed);
  std::vector<Location> samples;
  for (const int face : faces) {
    for (int k = perFace(faces, count); k > 0; --k) {
      const double distance = std::exp2(-random.uniform(distances.least, distances.most));
      double s = distance, t = distance * random.uniform();
      if (random.uniform() < 0.5) std::swap(s, t);
      samples.push_back(fromCorner(face, classified[face].ev_corner, s, t));
    }
  }
  return samples;
}

std::vector<Location> shuffled(std::vector<Location> samples) {
  test::BenchmarkRandom(kSeed + 1).shuffle(samples);
  return samples;
}

Location fromCorner(int face, int corner, double s, double t) {
  switch (corner) {
    case 0:
      return {face, s, t};
    case 1:
      return {face, 1 - t, s};
    case 2:
      return {face, 1 - s, 1 - t};
    default:
      return {face, t, 1 - s};
  }
}

}  // namespace limitsurf::bench
