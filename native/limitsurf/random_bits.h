// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace limitsurf {

/// The output function of SplitMix64 (Steele, Lea & Flood: "Fast Splittable Pseudorandom Number
/// Generators", 2014). It makes random bits of a counter, so that a sample depends on its seed and
/// its number alone.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The key of a seed: the bits of a counter are mixed(key ^ mixed(counter)). With the key
/// mixed(seed), the bits of counter a of seed b would be those of counter b of seed a.
inline std::uint64_t keyOf(std::uint64_t seed) { return mixed(mixed(seed)); }

/// A number in [0, 1), uniformly distributed if the bits are.
inline double uniformIn01(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace limitsurf
