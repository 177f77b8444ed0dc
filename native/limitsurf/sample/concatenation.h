// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "limitsurf/parallel.h"

namespace limitsurf {

/// The results of make(begin, end, results), called in parallel for ranges of at most `block` that
/// cover [0, count), one after the other. The ranges depend on `block` alone, not on the number of
/// threads.
template <typename T, typename Make>
std::vector<T> concatenated(std::size_t count, std::size_t block, int threads, const Make& make) {
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<std::vector<T>> parts(blocks);
  parallelFor(blocks, 1, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      make(i * block, std::min(count, (i + 1) * block), parts[i]);
    }
  });
  std::size_t size = 0;
  for (const std::vector<T>& part : parts) {
    size += part.size();
  }
  std::vector<T> all;
  all.reserve(size);
  for (const std::vector<T>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    InterruptionPoint::pass();
  }
  return all;
}

}  // namespace limitsurf
