// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace limitsurf {

/// A function that is called from time to time, on the calling thread, with the part of the work
/// that is done, 0 to 1. If it throws, the work ends.
using Progress = std::function<void(double part)>;

/// Tells how many of all things are done, if somebody wants to know.
inline void report(const Progress& progress, std::size_t done, std::size_t all) {
  if (progress) {
    progress(all ? static_cast<double>(done) / static_cast<double>(all) : 1);
  }
}

}  // namespace limitsurf
