// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

namespace limitsurf::python {

/// What is made of a surface's pose, or of values on it, at the first call that needs it, and kept
/// for the next.
template <typename T, typename Source>
class Lazily {
 public:
  /// To be called while the pose is held still.
  const T& get(const Source& source, int threads) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!made_) {
      made_ = std::make_unique<T>(source, threads);
    }
    return *made_;
  }
  void forget() { made_.reset(); }

 private:
  mutable std::mutex mutex_;
  mutable std::unique_ptr<T> made_;
};

}  // namespace limitsurf::python
