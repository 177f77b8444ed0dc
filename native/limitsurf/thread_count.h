// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace limitsurf {

/// Throws std::invalid_argument for a negative number.
inline void checkThreads(int threads) {
  if (threads < 0) {
    throw std::invalid_argument("threads is " + std::to_string(threads) +
                                "; expected 0 (all cores) or the largest number of cores to use");
  }
}

}  // namespace limitsurf
