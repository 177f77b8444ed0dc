// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// Makes room for `count` more values, and twice as much where the vector must move: that takes
/// long where it is large, and can be interrupted.
template <typename T>
void reserveMore(std::vector<T>& values, std::size_t count) {
  constexpr std::size_t kPart = std::size_t{1} << 16;
  if (count <= values.capacity() - values.size()) {
    return;
  }
  std::vector<T> larger;
  larger.reserve(std::max(2 * values.capacity(), values.size() + count));
  for (std::size_t begin = 0; begin < values.size(); begin += kPart) {
    const std::size_t end = std::min(begin + kPart, values.size());
    larger.insert(larger.end(), values.data() + begin, values.data() + end);
    InterruptionPoint::pass();
  }
  values.swap(larger);
}

}  // namespace limitsurf
