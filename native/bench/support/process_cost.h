// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace limitsurf::bench {

struct Cost {
  double seconds, cpu_seconds;
  double peak_mib, kept_mib;  ///< memory in addition to what the process held before
};

/// The CPU time of all threads of this process so far.
double cpuSeconds();

/// Makes an object, which lives until its cost has been measured.
using Opening = std::function<std::shared_ptr<void>()>;

/// Measures the cost of `open`, in a process of its own, after `prepare`, whose cost does not
/// count. It must be called before any thread starts. Returns false if that process failed.
bool measureApart(const Opening& open, Cost& cost, const std::function<void()>& prepare = {});

}  // namespace limitsurf::bench
