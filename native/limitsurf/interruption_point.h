// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

namespace limitsurf {

/// A function that is called on the calling thread from time to time during long work. If it
/// throws, the work ends. It is in effect for the lifetime of the object. Code that knows of
/// keyboards and progress bars makes one, and the library, which knows of neither, calls pass().
class InterruptionPoint {
 public:
  explicit InterruptionPoint(std::function<void()> call)
      : call_(std::move(call)), outer_(current()) {
    current() = this;
  }
  ~InterruptionPoint() { current() = outer_; }
  InterruptionPoint(const InterruptionPoint&) = delete;
  InterruptionPoint& operator=(const InterruptionPoint&) = delete;

  /// Whether this thread has a function.
  static bool any() { return current() != nullptr; }

  /// Calls the innermost function of this thread, if there is one.
  static void pass() {
    if (current()) {
      current()->call_();
    }
  }

 private:
  static InterruptionPoint*& current() {
    static thread_local InterruptionPoint* point = nullptr;
    return point;
  }

  std::function<void()> call_;
  InterruptionPoint* outer_;
};

/// Passes the interruption point now and then within a serial loop.
class InterruptionStride {
 public:
  /// Is called at each step of the loop, which takes up to some microseconds.
  void step() {
    if (++steps_ % kStride == 0) {
      InterruptionPoint::pass();
    }
  }

 private:
  static constexpr unsigned kStride = 256;
  unsigned steps_ = 0;
};

}  // namespace limitsurf
