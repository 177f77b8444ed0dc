// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <utility>

namespace limitsurf::python {

/// Keeps an object as it is while calls read it, and lets one call at a time change it. Calls hold
/// it for as long as they run, often for seconds, and run Python functions meanwhile: progress
/// functions, signal handlers, destructors that the garbage collector runs.
///
/// - Who comes first gets in first: a call that changes the object waits for those before it, and
///   calls that come later wait for that one. So nobody starves.
/// - A thread that already holds a lock reads at once unless somebody is changing the object, so
///   that a function may read what its own caller reads.
/// - What would wait for itself raises std::runtime_error, which is RuntimeError in Python: a
///   change within a call that reads, anything within a change, and two threads that wait for each
///   other.
/// - So does what would wait, in a process that was forked, for a thread of the parent.
/// - Ctrl-C ends the wait.
///
/// Nobody may hold the GIL while waiting.
class CallLock {
 public:
  enum class Access { read, change };

  /// `what` is named in errors: "LimitSurface". mend() makes the object whole again.
  explicit CallLock(const char* what, std::function<void()> mend = {})
      : what_(what), mend_(std::move(mend)) {}
  ~CallLock();
  CallLock(const CallLock&) = delete;
  CallLock& operator=(const CallLock&) = delete;

  const char* what() const { return what_; }

  /// Says whether a change has left the object as a whole. If not, the next call that reads calls
  /// mend() before, alone; Ctrl-C ends that as well. The lock must be held for a change.
  void setWhole(bool whole) const { is_whole_ = whole; }

  /// Has access for its lifetime. It belongs to the thread that makes it.
  class Hold {
   public:
    explicit Hold(const CallLock& lock, Access access = Access::read);
    ~Hold();
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    const CallLock& lock_;
  };

  /// Two objects are read; both may be the same.
  class HoldTwo {
   public:
    HoldTwo(const CallLock& a, const CallLock& b);
    ~HoldTwo();
    HoldTwo(const HoldTwo&) = delete;
    HoldTwo& operator=(const HoldTwo&) = delete;

   private:
    void acquire();
    void release();
    /// Releases both unless they are.
    bool isWhole();

    const CallLock &first_, &second_;
  };

 private:
  void mendIfBroken() const;

  const char* what_;
  std::function<void()> mend_;
  mutable std::atomic<bool> is_whole_{true};
};

}  // namespace limitsurf::python
