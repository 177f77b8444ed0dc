// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/worker_interruption.h"

#include <tbb/task_arena.h>

#include <atomic>
#include <mutex>

#include "limitsurf/loop_order.h"

namespace limitsurf {

class WorkerInterruption::Questions {
 public:
  /// Leaves one for each thread of the arena, unless earlier ones are still to be taken: a thread
  /// that knows nothing may take several.
  void leave() {
    if (left_ > 0) {
      return;
    }
    const int count = tbb::this_task_arena::max_concurrency();
    left_ = count;
    for (int i = 0; i < count; ++i) {
      tasks_.run([this] {
        const LoopOrder::Task task(order_);
        ask();
        --left_;
      });
    }
  }

  /// Throws what an interruption point threw, once.
  void rethrow() {
    if (!has_thrown_) {
      return;
    }
    std::exception_ptr thrown;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      thrown.swap(thrown_);
      has_thrown_ = false;
    }
    if (thrown) {
      std::rethrow_exception(thrown);
    }
  }

  /// Returns when all are answered. This thread takes up those that nobody has taken.
  void wait() { tasks_.wait(); }

 private:
  void ask() noexcept {
    try {
      InterruptionPoint::pass();
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!thrown_) {
        thrown_ = std::current_exception();
        has_thrown_ = true;
      }
    }
  }

  /// Belongs to no loop: a question may first be left within an inner loop, whose end is not the
  /// end of the task. So it is asked even where the loop has ended, which costs little.
  tbb::task_group_context context_{tbb::task_group_context::isolated};
  tbb::task_group tasks_{context_};
  std::atomic<int> left_{0};
  std::atomic<bool> has_thrown_{false};
  std::mutex mutex_;  // guards thrown_
  std::exception_ptr thrown_;
  LoopOrder order_;  // made last: the tasks come after all of this is made, and before its end
};

WorkerInterruption::WorkerInterruption() {
  point_.emplace([this] { pass(); });
  ++count();
}

void WorkerInterruption::leave() {
  if (point_) {
    point_.reset();
    --count();
  }
}

WorkerInterruption::~WorkerInterruption() {
  leave();
  if (questions_) {
    questions_->wait();
  }
}

void WorkerInterruption::end() {
  leave();
  if (questions_) {
    questions_->wait();
    questions_->rethrow();
  }
}

void WorkerInterruption::pass() {
  endWithLoop();
  if (questions_) {
    questions_->rethrow();
  }
  if (Clock::now() < next_) {
    return;
  }
  next_ = Clock::now() + kBetween;
  if (!questions_) {
    questions_ = std::make_unique<Questions>();
  }
  questions_->leave();
}

}  // namespace limitsurf
