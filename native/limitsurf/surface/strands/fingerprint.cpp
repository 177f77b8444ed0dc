// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/fingerprint.h"

#include <cstring>

namespace limitsurf {
namespace {

/// A 64-bit word mixed into a hash, after the finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0xbf58476d1ce4e5b9u;
  return hash ^ (hash >> 32);
}

}  // namespace

std::int32_t fingerprint(const float* points, std::size_t count) {
  std::size_t bytes = count * 3 * sizeof(float);
  std::uint64_t hash = mixed(0x9e3779b97f4a7c15u, bytes);
  const char* at = reinterpret_cast<const char*>(points);
  for (; bytes >= sizeof(std::uint64_t); bytes -= sizeof(std::uint64_t)) {
    std::uint64_t word;
    std::memcpy(&word, at, sizeof word);
    hash = mixed(hash, word);
    at += sizeof word;
  }
  if (bytes > 0) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, bytes);
    hash = mixed(hash, word);
  }
  hash = (hash ^ (hash >> 29)) * 0x94d049bb133111ebu;
  const auto high = static_cast<std::uint32_t>(hash >> 32);
  const std::uint32_t never_zero = high == 0 ? 1 : high;
  std::int32_t result;
  std::memcpy(&result, &never_zero, sizeof result);
  return result;
}

}  // namespace limitsurf
