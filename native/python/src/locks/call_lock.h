// SPDX-License-Identifier: Apache-2.0
#pragma once

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
/// change
///   within a call that reads, anything within a change, and two threads that wait for each other.
/// - So does what would wait, in a process that was forked, for a thread of the parent.
/// - Ctrl-C ends the wait.
///
/// Nobody may hold the GIL while waiting.
class CallLock {
 public:
  enum class Access { read, change };

  /// `what` is named in errors: "LimitSurface".
  explicit CallLock(const char* what) : what_(what) {}
  ~CallLock();
  CallLock(const CallLock&) = delete;
  CallLock& operator=(const CallLock&) = delete;

  const char* what() const { return what_; }

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
    const CallLock &first_, &second_;
  };

 private:
  const char* what_;
};

}  // namespace limitsurf::python
