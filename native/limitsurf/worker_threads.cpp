// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/worker_threads.h"

#include <atomic>

#if !defined(_WIN32)
#include <pthread.h>
#endif

namespace limitsurf {
namespace {

std::atomic<bool> lost{false};

}  // namespace

bool workerThreadsExist() {
#if !defined(_WIN32)
  [[maybe_unused]] static const int watched =
      pthread_atfork(nullptr, nullptr, [] { lost.store(true); });
#endif
  return !lost.load(std::memory_order_relaxed);
}

}  // namespace limitsurf
