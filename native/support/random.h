// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "limitsurf/random_bits.h"
#include "limitsurf/types.h"

namespace limitsurf::test {

/// SplitMix64 as an engine.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}
  std::uint64_t operator()() {
    const std::uint64_t bits = mixed(state_);
    state_ += 0x9e3779b97f4a7c15u;
    return bits;
  }

 private:
  std::uint64_t state_;
};

/// Random numbers that are the same on every machine, unlike those of the standard's distributions.
template <typename Engine>
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count).
  template <typename Integer>
  Integer below(Integer count) {
    return static_cast<Integer>(bits() % static_cast<std::uint64_t>(count));
  }
  Vector3 vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }
  template <typename T>
  void shuffle(std::vector<T>& elements) {
    for (std::size_t i = elements.size(); i > 1; --i) {
      std::swap(elements[i - 1], elements[below(i)]);
    }
  }

 private:
  Engine engine_;
};

/// The tests' random numbers.
using Random = RandomNumbers<SplitMix64>;

/// The benchmarks' random numbers. They have another engine than the tests', so that meshes and
/// places stay those of the figures that were measured before.
using BenchmarkRandom = RandomNumbers<std::mt19937_64>;

}  // namespace limitsurf::test
