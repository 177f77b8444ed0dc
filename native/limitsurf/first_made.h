// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace limitsurf {

/// A value that is made when it is first needed, by any number of threads. Whoever finds it missing
/// makes it, and the first one that is ready is kept. Nobody waits for another, who might be in a
/// function that this call has called, or in a process from which this one was forked.
template <typename T>
class FirstMade {
 public:
  FirstMade() = default;
  ~FirstMade() { delete made_.load(); }
  FirstMade(const FirstMade&) = delete;
  FirstMade& operator=(const FirstMade&) = delete;

  /// The value, or null if it is not made yet.
  const T* made() const { return made_.load(std::memory_order_acquire); }
  /// The value; make() returns a new one, a std::unique_ptr.
  template <typename Make>
  const T& get(const Make& make) const {
    const T* made = made_.load(std::memory_order_acquire);
    if (!made) {
      auto own = make();
      if (made_.compare_exchange_strong(made, own.get(), std::memory_order_acq_rel)) {
        made = own.release();
      }
    }
    return *made;
  }

 private:
  mutable std::atomic<const T*> made_{nullptr};
};

}  // namespace limitsurf
