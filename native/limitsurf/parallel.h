// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "limitsurf/interruption_point.h"
#include "limitsurf/loop_order.h"
#include "limitsurf/thread_count.h"
#include "limitsurf/worker_threads.h"

namespace limitsurf {

/// The number of rows of a batch that make one task, where a row takes about as long as an
/// evaluation: long enough (some 50 microseconds) that starting a task costs little.
constexpr std::size_t kRowsPerTask = 512;

/// Calls body(begin, end) for ranges that cover [0, count), on all cores (threads = 0) or on at
/// most `threads` of them. A range has about `grain` elements; InterruptionPoint::pass() is called
/// after each range that the calling thread has worked on. What a body does must not depend on how
/// the range is divided.
template <typename Body>
void parallelFor(std::size_t count, std::size_t grain, int threads, const Body& body) {
  constexpr std::size_t kGrainsPerSlab = 32;
  const auto slab = [&](std::size_t first, std::size_t last) {
    if (threads == 1 || last - first <= grain || !workerThreadsExist()) {
      for (std::size_t begin = first; begin < last; begin += grain) {
        body(begin, std::min(last, begin + grain));
        InterruptionPoint::pass();
      }
      return;
    }
    LoopOrder order;
    const auto run = [&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          const LoopOrder::Task task(order);
                          body(range.begin(), range.end());
                          InterruptionPoint::pass();  // it belongs to the calling thread
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
