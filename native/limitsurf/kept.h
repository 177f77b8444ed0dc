// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

namespace limitsurf {

/// What one call has worked with, for the next one: to get memory from the system takes as long as
/// to fill it. Calls that run at the same time do not share it. All members may be called from many
/// threads at once.
template <typename T>
class Kept {
 public:
  Kept() = default;
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept() { delete kept_.load(); }

  /// What was given back last, or null.
  std::unique_ptr<T> take() const { return std::unique_ptr<T>(kept_.exchange(nullptr)); }
  void giveBack(std::unique_ptr<T> value) const { delete kept_.exchange(value.release()); }

 private:
  mutable std::atomic<T*> kept_{nullptr};
};

}  // namespace limitsurf
