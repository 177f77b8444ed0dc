// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/loop_order.h"

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

/// Throws std::invalid_argument for a negative number.
inline void checkThreads(int threads) {
  if (threads < 0) {
    throw std::invalid_argument("threads is " + std::to_string(threads) +
                                "; expected 0 (all cores) or the largest number of cores to use");
  }
}

/// The number of rows of a batch that make one task, where a row takes about as long as an
/// evaluation: long enough (some 50 microseconds) that starting a task costs little.
constexpr std::size_t kRowsPerTask = 512;

/// Calls body(begin, end) for ranges that cover [0, count), on all cores (threads = 0) or on at
/// most `threads` of them. A range has about `grain` elements; InterruptionPoint::pass() is called
/// after every kGrainsPerSlab of them. What a body does must not depend on how the range is
/// divided.
template <typename Body>
void parallelFor(std::size_t count, std::size_t grain, int threads, const Body& body) {
  constexpr std::size_t kGrainsPerSlab = 32;
  const auto slab = [&](std::size_t first, std::size_t last) {
    if (threads == 1 || last - first <= grain) {
      body(first, last);
      return;
    }
    LoopOrder order;
    const auto run = [&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          const LoopOrder::Task task(order);
                          body(range.begin(), range.end());
                        });
    };
    if (threads == 0) {
      run();
    } else {
      // TBB warns of an arena with more threads than the machine has cores.
      tbb::task_arena arena(std::min(threads, tbb::this_task_arena::max_concurrency()));
      arena.execute(run);
    }
  };
  for (std::size_t first = 0; first < count;) {
    const std::size_t last = std::min(count, first + kGrainsPerSlab * grain);
    slab(first, last);
    InterruptionPoint::pass();
    first = last;
  }
}

}  // namespace limitsurf
