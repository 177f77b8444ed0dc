// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "limitsurf/parallel.h"

namespace limitsurf {

/// The number of rows of the parts into which a batch is divided for work in steps that hand each
/// other arrays: so few that these arrays stay in the cache and that all threads have some parts,
/// and so many that rows of the same face meet in them.
inline std::size_t rowsOfPart(std::size_t count, int threads) {
  constexpr std::size_t kParts = 64, kFewest = std::size_t{1} << 11, kMost = std::size_t{1} << 12;
  return threads == 1 ? kMost : std::clamp(count / kParts, kFewest, kMost);
}

/// Calls body(begin, end) for parts of a batch of `count` rows, as parallelFor() does.
template <typename Body>
void forEachPart(std::size_t count, int threads, const Body& body) {
  parallelFor(count, rowsOfPart(count, threads), threads, body);
}

/// Calls body(begin, end, memory) for these parts. `memory` is what make(rows) returns, with room
/// for the rows of a part. There is one for each thread, which serves one part after the other:
/// fresh memory costs as much as filling it.
template <typename Make, typename Body>
void forEachPart(std::size_t count, int threads, const Make& make, const Body& body) {
  using Memory = decltype(make(count));
  std::vector<Memory> unused;
  std::mutex mutex;  // of `unused`
  forEachPart(count, threads, [&](std::size_t begin, std::size_t end) {
    std::optional<Memory> memory;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!unused.empty()) {
        memory.emplace(std::move(unused.back()));
        unused.pop_back();
      }
    }
    if (!memory) {
      memory.emplace(make(std::min(rowsOfPart(count, threads), count)));
    }
    body(begin, end, *memory);
    const std::lock_guard<std::mutex> lock(mutex);
    unused.push_back(std::move(*memory));
  });
}

}  // namespace limitsurf
