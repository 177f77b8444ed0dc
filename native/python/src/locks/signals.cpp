// SPDX-License-Identifier: Apache-2.0
#include "signals.h"

#include <chrono>
#include <utility>

#include "gil.h"

namespace limitsurf::python {

namespace {

/// Whoever asks for the GIL waits for other threads, some milliseconds each time.
constexpr std::chrono::milliseconds kBetween{20};

}  // namespace

void lookForSignals() {
  withGil([] {
    if (PyErr_CheckSignals() != 0) {
      throw pybind11::error_already_set();
    }
  });
}

InterruptionPoint interruptible(std::function<void()> also) {
  using Clock = std::chrono::steady_clock;
  return InterruptionPoint([also = std::move(also), next = Clock::now() + kBetween]() mutable {
    if (Clock::now() >= next) {
      lookForSignals();
      if (also) {
        also();
      }
      next = Clock::now() + kBetween;
    }
  });
}

}  // namespace limitsurf::python
