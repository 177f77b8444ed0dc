// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "call_lock.h"

namespace limitsurf::python {

/// A value that is made of a surface's pose, or of data, by the first call that needs it, and kept
/// for later calls. `what` is named in errors.
template <typename T, typename Source>
class KeptValue {
 public:
  explicit KeptValue(const char* what) : making_(what) {}
  ~KeptValue() { forget(); }
  KeptValue(const KeptValue&) = delete;
  KeptValue& operator=(const KeptValue&) = delete;

  /// The value, made now if there is none. The pose must not change during the call.
  const T& get(const Source& source, int threads) const {
    if (const T* const made = made_.load(std::memory_order_acquire)) {
      return *made;
    }
    const CallLock::Hold hold(making_, CallLock::Access::change);
    if (!made_.load(std::memory_order_acquire)) {
      made_.store(new T(source, threads), std::memory_order_release);
    }
    return *made_.load(std::memory_order_relaxed);
  }
  /// Nobody may be using the value.
  void forget() { delete made_.exchange(nullptr); }

 private:
  CallLock making_;
  mutable std::atomic<const T*> made_{nullptr};
};

}  // namespace limitsurf::python
