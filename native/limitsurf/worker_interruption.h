// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <chrono>
#include <exception>
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
/// of others. So this one leaves tasks to be taken from time to time, which pass the interruption
/// point of whoever takes them. What that throws, this thread throws in turn, and so ends the loop.
class WorkerInterruption {
 public:
  WorkerInterruption() : point_([this] { pass(); }) {}
  ~WorkerInterruption() {
    try {
      settle();
    } catch (...) {  // NOLINT(bugprone-empty-catch): a destructor throws nothing
      // The task is done, or ends with an exception of its own; the caller will be asked again.
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// As often as the caller looks for signals.
  static constexpr std::chrono::milliseconds kBetween{20};

  void pass() {
    endWithLoop();
    if (Clock::now() < next_) {
      return;
    }
    next_ = Clock::now() + kBetween;
    settle();
    left_.emplace();
    for (int i = 0; i < tbb::this_task_arena::max_concurrency(); ++i) {  // others may take some
      left_->run([] { InterruptionPoint::pass(); });
    }
  }

  /// Ends the tasks that were left. This thread takes them up itself if nobody has.
  void settle() {
    if (left_) {
      left_->wait();
      left_.reset();
    }
  }

  std::optional<tbb::task_group> left_;
  Clock::time_point next_ = Clock::now() + kBetween;
  const InterruptionPoint point_;
};

}  // namespace limitsurf
