// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace limitsurf {

/// The order in which a parallel loop runs, told to ThreadSanitizer: the caller's writes come
/// before every task of the loop, and every task comes before the loop's end. ThreadSanitizer does
/// not see this by itself, because TBB's library is not compiled with it. Tasks are not ordered
/// among each other, so that a race between two of them is found. Other builds call nothing.
class LoopOrder {
 public:
  LoopOrder() { release(start_); }
  ~LoopOrder() { acquire(end_); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

  /// Stands in each task for as long as it runs.
  class Task {
   public:
    explicit Task(LoopOrder& loop) : loop_(loop) { acquire(loop_.start_); }
    ~Task() { release(loop_.end_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    LoopOrder& loop_;
  };

 private:
#if defined(__SANITIZE_THREAD__)
  static void acquire(char& place) { __tsan_acquire(&place); }
  static void release(char& place) { __tsan_release(&place); }
#else
  static void acquire(char&) {}
  static void release(char&) {}
#endif

  char start_ = 0;
  char end_ = 0;
};

}  // namespace limitsurf
