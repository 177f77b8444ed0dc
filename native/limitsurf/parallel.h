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

/// What the calling thread wants to be asked every now and then while it works for long: may throw,
/// which ends the work. Set for a scope, by those who know of keyboards and progress bars.
class InterruptionPoint {
 public:
  explicit InterruptionPoint(std::function<void()> ask) : ask_(std::move(ask)), outer_(current()) {
    current() = this;
  }
  ~InterruptionPoint() { current() = outer_; }
  InterruptionPoint(const InterruptionPoint&) = delete;
  InterruptionPoint& operator=(const InterruptionPoint&) = delete;

  static void pass() {
    if (current()) {
      current()->ask_();
    }
  }

 private:
  static InterruptionPoint*& current() {
    static thread_local InterruptionPoint* point = nullptr;
    return point;
  }

  std::function<void()> ask_;
  InterruptionPoint* outer_;
};

/// Throws std::invalid_argument for a negative number.
inline void checkThreads(int threads) {
  if (threads < 0) {
    throw std::invalid_argument("threads is " + std::to_string(threads) +
                                "; 0 means all cores, n at most n");
  }
}

/// The rows of a batch that make one task, where a row costs about as much as an evaluation.
constexpr std::size_t kRowsPerTask = 512;

/// Calls body(begin, end) for ranges that cover [0, count), on all cores (threads = 0) or at most
/// `threads` of them, with an InterruptionPoint after every so many. Bodies must not depend on how
/// the range is cut.
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
      // An arena wider than the machine only draws a warning from TBB.
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
