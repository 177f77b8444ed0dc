// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "limitsurf/interruption_point.h"
#include "limitsurf/process.h"

namespace limitsurf {

/// Returns work(), for work that knows of no interruption points: it is done on a thread of its
/// own while the calling thread passes them. If one ends the call, that thread goes on to the end
/// of its work, whose result nobody takes; or to the end of the process, which does not wait for
/// it.
///
/// So the work must own everything that it uses. It is const, because it is done once more where an
/// interruption point forks the process: in the child that thread does not exist.
template <typename Work>
auto workAside(Work work) -> decltype(std::as_const(work)()) {
  constexpr std::chrono::milliseconds kBetween{20};
  const auto shared = std::make_shared<const Work>(std::move(work));
  std::packaged_task<decltype((*shared)())()> task([shared] { return (*shared)(); });
  auto result = task.get_future();
  const ProcessNumber process = thisProcess();
  try {
    std::thread(std::move(task)).detach();
  } catch (const std::system_error&) {  // the system grants no more threads
    return (*shared)();
  }
  while (result.wait_for(kBetween) != std::future_status::ready) {
    InterruptionPoint::pass();
    if (thisProcess() != process) {
      return (*shared)();
    }
  }
  return result.get();
}

}  // namespace limitsurf
