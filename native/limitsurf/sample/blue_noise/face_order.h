// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "limitsurf/parallel.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The numbers of locations, sorted by face. Those of a face stay in their order. Faces are below
/// `faces`.
inline std::vector<std::size_t> orderByFace(const std::vector<Location>& at, std::size_t faces) {
  std::vector<std::size_t> next(faces + 1, 0), order(at.size());
  for (const Location& location : at) {
    ++next[static_cast<std::size_t>(location.face) + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t i = 0; i < at.size(); ++i) {
    order[next[static_cast<std::size_t>(at[i].face)]++] = i;
  }
  return order;
}

/// Elements in an order, which is given as their numbers.
template <typename T>
std::vector<T> ordered(const std::vector<T>& all, const std::vector<std::size_t>& order,
                       int threads) {
  constexpr std::size_t kElementsPerTask = 1 << 13;
  std::vector<T> result(all.size());
  parallelFor(order.size(), kElementsPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result[i] = all[order[i]];
    }
  });
  return result;
}

}  // namespace limitsurf
