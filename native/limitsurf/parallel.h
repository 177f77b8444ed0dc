// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace limitsurf {

/// Calls body(begin, end) for ranges that cover [0, count), on all cores (threads = 0) or at most
/// `threads` of them. Bodies must not depend on how the range is cut.
template <typename Body>
void parallelFor(std::size_t count, std::size_t grain, int threads, const Body& body) {
  if (count == 0) {
    return;
  }
  const auto run = [&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
  };
  if (threads == 1 || count <= grain) {
    body(std::size_t{0}, count);
  } else if (threads == 0) {
    run();
  } else {
    // An arena wider than the machine only draws a warning from TBB.
    tbb::task_arena arena(std::min(threads, tbb::this_task_arena::max_concurrency()));
    arena.execute(run);
  }
}

}  // namespace limitsurf
