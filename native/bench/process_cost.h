// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace limitsurf::bench {

struct Cost {
  double seconds, cpu_seconds;
  double peak_mib, kept_mib;  ///< above what the process held before
};

/// Of all threads of this process so far.
double cpuSeconds();

/// Makes something, which lives until it has been measured.
using Opening = std::function<std::shared_ptr<void>()>;

/// What `open` costs, in a process of its own, after `prepare`, which does not count. To be called
/// before any thread starts. False if the process that did the work failed.
bool measureApart(const Opening& open, Cost& cost, const std::function<void()>& prepare = {});

}  // namespace limitsurf::bench
