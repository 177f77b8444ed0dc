// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// std::sort() that can be interrupted: a million values take a tenth of a second. Afterwards the
/// order of the values is not known.
template <typename Iterator, typename Less = std::less<>>
void sortInterruptibly(Iterator begin, Iterator end, Less less = {}) {
  InterruptionStride stride;
  std::sort(begin, end, [&](const auto& a, const auto& b) {
    stride.step();
    return less(a, b);
  });
}

}  // namespace limitsurf
