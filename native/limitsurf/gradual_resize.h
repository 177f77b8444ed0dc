// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// Like values.resize(count) for results that may have gigabytes. The system hands out memory page
/// by page when it is first written to, which takes about a second for some gigabytes, so the
/// interruption point is passed after every few megabytes.
template <typename T, typename Allocator>
void resizeGradually(std::vector<T, Allocator>& values, std::size_t count) {
  constexpr std::size_t kBytesPerStep = std::size_t{8} << 20;
  constexpr std::size_t kStep = std::max<std::size_t>(kBytesPerStep / sizeof(T), 1);
  values.reserve(count);
  while (values.size() + kStep < count) {
    values.resize(values.size() + kStep);
    InterruptionPoint::pass();
  }
  values.resize(count);
}

}  // namespace limitsurf
