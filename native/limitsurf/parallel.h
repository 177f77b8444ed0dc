// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <optional>

#include "limitsurf/interruption_point.h"
#include "limitsurf/loop_order.h"
#include "limitsurf/thread_count.h"
#include "limitsurf/worker_interruption.h"
#include "limitsurf/worker_threads.h"

namespace limitsurf {

/// The number of rows of a batch that make one task, where a row takes about as long as an
/// evaluation: long enough (some 50 microseconds) that starting a task costs little.
constexpr std::size_t kRowsPerTask = 512;

/// Calls body(begin, end) for ranges that cover [0, count), on all cores (threads = 0) or on at
/// most `threads` of them. All ranges but the last have `grain` elements. What a body does must not
/// depend on how the range is divided. It may call parallelFor(): if an exception ends the outer
/// loop, the inner ones end after their present ranges, with LoopEnded. Within a task of an
/// interruptible loop, an inner one takes the threads of the outer one, whatever `threads` is:
/// questions to the caller (WorkerInterruption) would not leave an arena of its own.
///
/// InterruptionPoint::pass() is called after each range. On the calling thread it calls the
/// caller's interruption point. On others it ends the range if the loop has ended, and a body that
/// calls it during a long range has the caller hear of interruptions all the same
/// (WorkerInterruption).
///
/// Each thread works through a part of [0, count) from its beginning on, and one that has nothing
/// left takes over the second half of what another has before it. So threads wait for each other
/// only once, at the end, and they write to memory far apart: two that write to the same page for
/// the first time (2 MiB where memory has large pages) would both clear it.
template <typename Body>
void parallelFor(std::size_t count, std::size_t grain, int threads, const Body& body) {
  const auto callFor = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      body(i * grain, std::min(count, (i + 1) * grain));
      InterruptionPoint::pass();
      endWithLoop();
    }
  };
  const std::size_t ranges = count / grain + (count % grain > 0 ? 1 : 0);
  if (threads == 1 || ranges <= 1 || !workerThreadsExist()) {
    callFor(0, ranges);
    return;
  }
  {
    LoopOrder order;
    const bool is_interruptible = InterruptionPoint::any();
    const auto run = [&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, ranges),
          [&](const tbb::blocked_range<std::size_t>& some) {
            const LoopOrder::Task task(order);
            std::optional<WorkerInterruption> interruption;
            if (is_interruptible && !InterruptionPoint::any()) {
              interruption.emplace();
            }
            callFor(some.begin(), some.end());
            if (interruption) {
              interruption->end();
            }
          },
          tbb::simple_partitioner());
    };
    if (threads == 0 || WorkerInterruption::any()) {
      run();
    } else {
      // TBB warns of an arena with more threads than the machine has cores.
      tbb::task_arena arena(std::min(threads, tbb::this_task_arena::max_concurrency()));
      arena.execute(run);
    }
  }
  endWithLoop();
  InterruptionPoint::pass();
}

}  // namespace limitsurf
