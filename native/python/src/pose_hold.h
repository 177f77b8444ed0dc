// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <shared_mutex>

namespace limitsurf::python {

/// Keeps a pose, or values, unchanged during a call that may call Python functions. Such a function
/// may read them as well, but must not set them: setting waits for the call to end, which waits for
/// the function. isHeldHere() lets setters refuse that.
template <typename Shared>
class PoseHold {
 public:
  explicit PoseHold(const Shared& shared)
      : shared_(shared), lock_(shared.mutex), outer_(innermost()) {
    innermost() = this;
  }
  ~PoseHold() { innermost() = outer_; }
  PoseHold(const PoseHold&) = delete;
  PoseHold& operator=(const PoseHold&) = delete;

  /// Whether a call that is under way on this thread keeps `shared` unchanged.
  static bool isHeldHere(const Shared& shared) {
    const PoseHold* held = innermost();
    while (held && &held->shared_ != &shared) {
      held = held->outer_;
    }
    return held != nullptr;
  }

 private:
  static PoseHold*& innermost() {
    static thread_local PoseHold* held = nullptr;
    return held;
  }

  const Shared& shared_;
  std::shared_lock<std::shared_mutex> lock_;
  PoseHold* outer_;
};

}  // namespace limitsurf::python
