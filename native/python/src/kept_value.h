// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>

namespace limitsurf::python {

/// A value that is made of a surface's pose, or of data, by the first call that needs it, and kept
/// for later calls.
template <typename T, typename Source>
class KeptValue {
 public:
  /// The value, made now if there is none. The pose must not change during the call.
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
