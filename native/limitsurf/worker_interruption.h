// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task_group.h>

#include <chrono>
#include <exception>
#include <memory>
#include <optional>

#include "limitsurf/interruption_point.h"

namespace limitsurf {

/// Ends a task of a parallel loop that has already ended with an exception elsewhere, which TBB
/// keeps: it drops this one in favour of that.
struct LoopEnded : std::exception {};

/// Is called between parts of the work of a task.
inline void endWithLoop() {
  if (tbb::is_current_task_group_canceling()) {
    throw LoopEnded();
  }
}

/// The interruption point of a thread that works on a task of a parallel loop for the thread that
/// has called the loop. It ends the task when the loop has ended.
///
/// The caller's own interruption point belongs to the caller, who may have nothing left to do but
/// to wait for this thread, as long as its task takes. A waiting thread of TBB takes up small tasks
/// of others. So this one leaves questions to be taken from time to time: tasks that pass the
/// interruption point of whoever takes them. What that throws, this thread throws in turn, and so
/// ends the loop.
///
/// Nobody waits for a question to be answered before the task ends. Whoever waits in TBB takes up
/// other tasks, a question among them, perhaps one of its own: to wait within a question could be
/// to wait for oneself.
class WorkerInterruption {
 public:
  WorkerInterruption();
  /// Waits until nobody has a question of this thread any more.
  ~WorkerInterruption();
  WorkerInterruption(const WorkerInterruption&) = delete;
  WorkerInterruption& operator=(const WorkerInterruption&) = delete;

  /// The same, and throws what an interruption point threw after the last pass of this one. Is
  /// called once, at the end of the task.
  void end();

  /// Whether one is in effect on this thread.
  static bool any() { return count() > 0; }

 private:
  class Questions;
  using Clock = std::chrono::steady_clock;
  /// As often as the caller looks for signals.
  static constexpr std::chrono::milliseconds kBetween{20};

  static int& count() {
    static thread_local int count = 0;
    return count;
  }
  void pass();
  /// Takes it out of effect: tasks that this thread takes up while it waits are not part of this
  /// one.
  void leave();

  std::unique_ptr<Questions> questions_;  // none before the first is left: most tasks are short
  Clock::time_point next_ = Clock::now() + kBetween;
  std::optional<InterruptionPoint> point_;
};

}  // namespace limitsurf
