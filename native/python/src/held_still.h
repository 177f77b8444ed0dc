// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <shared_mutex>

namespace limitsurf::python {

/// Holds a pose, or values, still during a call that calls back into Python. What it calls may read
/// them as well, but must not set them: that would wait for itself for ever.
template <typename Shared>
class HeldStill {
 public:
  explicit HeldStill(const Shared& shared)
      : shared_(shared), lock_(shared.mutex), outer_(innermost()) {
    innermost() = this;
  }
  ~HeldStill() { innermost() = outer_; }
  HeldStill(const HeldStill&) = delete;
  HeldStill& operator=(const HeldStill&) = delete;

  /// Whether a call further up on this thread does.
  static bool isHeldHere(const Shared& shared) {
    const HeldStill* held = innermost();
    while (held && &held->shared_ != &shared) {
      held = held->outer_;
    }
    return held != nullptr;
  }

 private:
  static HeldStill*& innermost() {
    static thread_local HeldStill* held = nullptr;
    return held;
  }

  const Shared& shared_;
  std::shared_lock<std::shared_mutex> lock_;
  HeldStill* outer_;
};

}  // namespace limitsurf::python
