// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace limitsurf {
namespace {

TEST(ParallelFor, RangesHaveAsManyElementsAsTheyShallHave) {
  constexpr std::size_t kCount = 10'007, kGrain = 64;
  for (const int threads : {0, 1, 2, 3}) {
    std::vector<std::atomic<int>> visits(kCount);
    std::atomic<int> others{0};
    parallelFor(kCount, kGrain, threads, [&](std::size_t begin, std::size_t end) {
      others += begin % kGrain != 0 || (end - begin != kGrain && end != kCount) ? 1 : 0;
      for (std::size_t i = begin; i < end; ++i) {
        ++visits[i];
      }
    });
    EXPECT_EQ(others, 0) << threads;
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(visits[i], 1) << threads << ", " << i;
    }
  }
  parallelFor(0, kGrain, 2, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, NoThreadWaitsForAnotherBeforeTheEnd) {
  if (tbb::this_task_arena::max_concurrency() < 2) {
    GTEST_SKIP() << "one core";
  }
  // One thread stays in its first range until all other ranges are done.
  constexpr std::size_t kRanges = 1000;
  constexpr std::chrono::seconds kLimit{60};
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done{0};
  std::atomic<bool> waits{false};
  parallelFor(kRanges, 1, 2, [&](std::size_t, std::size_t) {
    if (std::this_thread::get_id() == caller && !waits.exchange(true)) {
      const auto end = std::chrono::steady_clock::now() + kLimit;
      while (done < kRanges - 1 && std::chrono::steady_clock::now() < end) {
        std::this_thread::yield();
      }
      EXPECT_EQ(done, kRanges - 1);
    }
    ++done;
  });
  EXPECT_EQ(done, kRanges);
}

TEST(ParallelFor, CallsTheInterruptionPointAfterEachRangeOfTheCaller) {
  for (const int threads : {1, 2}) {
    const std::thread::id caller = std::this_thread::get_id();
    int own = 0, calls = 0;
    bool is_late = false;
    const InterruptionPoint point([&] { ++calls; });
    parallelFor(100, 1, threads, [&](std::size_t, std::size_t) {
      if (std::this_thread::get_id() == caller) {
        is_late |= calls < own;
        ++own;
      }
    });
    EXPECT_FALSE(is_late) << threads;
    EXPECT_GE(calls, own) << threads;
  }
}

TEST(ParallelFor, WhatTheInterruptionPointThrowsEndsTheLoop) {
  for (const int threads : {0, 1, 2}) {
    std::atomic<int> ranges{0};
    const InterruptionPoint point([] { throw std::runtime_error("enough"); });
    EXPECT_THROW(parallelFor(100'000, 1, threads,
                             [&](std::size_t, std::size_t) {
                               ++ranges;
                               std::this_thread::sleep_for(std::chrono::microseconds(10));
                             }),
                 std::runtime_error);
    EXPECT_LT(ranges, 100'000) << threads;
  }
}

/// A loop of two ranges: one of a worker thread, which passes interruption points for as long as
/// nothing ends it, and a short one of the caller. Returns whether the long one was ended.
bool endsLongRange(int threads, const std::function<void()>& on_caller) {
  constexpr std::chrono::seconds kLimit{60};
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> begun{false}, was_ended{false};
  const auto isLate = [end = std::chrono::steady_clock::now() + kLimit] {
    return std::chrono::steady_clock::now() > end;
  };
  EXPECT_THROW(parallelFor(2, 1, threads,
                           [&](std::size_t, std::size_t) {
                             if (std::this_thread::get_id() == caller) {
                               while (!begun && !isLate()) {
                                 std::this_thread::yield();
                               }
                               on_caller();
                               return;
                             }
                             begun = true;
                             try {
                               while (!isLate()) {
                                 InterruptionPoint::pass();
                               }
                             } catch (...) {
                               was_ended = true;
                               throw;
                             }
                           }),
               std::runtime_error);
  return was_ended;
}

TEST(ParallelFor, AnExceptionOfTheCallerEndsALongRangeOfAnotherThread) {
  if (tbb::this_task_arena::max_concurrency() < 2) {
    GTEST_SKIP() << "one core";
  }
  const InterruptionPoint point([] {});
  for (const int threads : {0, 2}) {
    EXPECT_TRUE(endsLongRange(threads, [] { throw std::runtime_error("enough"); })) << threads;
  }
}

/// The caller has nothing left to do but to wait for the other thread.
TEST(ParallelFor, AnInterruptionPointIsPassedWhileTheCallerWaits) {
  if (tbb::this_task_arena::max_concurrency() < 2) {
    GTEST_SKIP() << "one core";
  }
  for (const int threads : {0, 2}) {
    int calls = 0;
    const InterruptionPoint point([&] {
      if (++calls > 3) {
        throw std::runtime_error("enough");
      }
    });
    EXPECT_TRUE(endsLongRange(threads, [] {})) << threads;
  }
}

/// Whether a call on another thread returns. If it does not, that thread is left to itself.
bool returns(const std::function<void()>& call) {
  constexpr std::chrono::seconds kLimit{120};
  std::packaged_task<void()> task(call);
  std::future<void> end = task.get_future();
  std::thread(std::move(task)).detach();
  if (end.wait_for(kLimit) != std::future_status::ready) {
    return false;
  }
  end.get();
  return true;
}

/// Longer than the time after which a worker thread asks the caller again.
constexpr std::chrono::milliseconds kLong{30};

/// A thread that is kept from running between its last two passes finds its own questions at the
/// end, long after it has left them.
TEST(WorkerInterruption, AnswersItsOwnQuestionsHoweverLate) {
  EXPECT_TRUE(returns([] {
    tbb::task_arena(1).execute([] {
      const WorkerInterruption interruption;
      for (int i = 0; i < 3; ++i) {
        std::this_thread::sleep_for(kLong);
        InterruptionPoint::pass();
      }
      std::this_thread::sleep_for(kLong);
    });
  }));
}

/// Threads that wait at the end of an inner loop take up tasks of the outer one, and questions.
TEST(WorkerInterruption, LoopsWithinLoopsEndHoweverLongTheirRangesAre) {
  EXPECT_TRUE(returns([] {
    for (const int threads : {0, 3}) {
      std::atomic<int> passes{0}, ranges{0};
      const InterruptionPoint point([&] { ++passes; });
      const auto range = [&ranges](std::size_t begin, std::size_t) {
        for (std::size_t i = 0; i < 1 + begin % 3; ++i) {
          std::this_thread::sleep_for(kLong / 2);
          InterruptionPoint::pass();
        }
        ++ranges;
      };
      parallelFor(6, 1, threads, [&](std::size_t, std::size_t) { parallelFor(5, 1, 0, range); });
      EXPECT_EQ(ranges, 30) << threads;
      EXPECT_GT(passes, 0) << threads;
    }
  }));
}

/// The inner loop asks for fewer threads than there are: it would have an arena of its own, which
/// nobody enters any more when it has ended.
TEST(WorkerInterruption, InnerLoopsOfFewThreadsEnd) {
  EXPECT_TRUE(returns([] {
    for (const int threads : {0, 2}) {
      std::atomic<int> ranges{0};
      const InterruptionPoint point([] {});
      parallelFor(6, 1, threads, [&](std::size_t, std::size_t) {
        parallelFor(6, 1, 2, [&](std::size_t, std::size_t) {
          std::this_thread::sleep_for(kLong / 2);
          ++ranges;
        });
      });
      EXPECT_EQ(ranges, 36) << threads;
    }
  }));
}

/// An inner loop that ends early because the outer one has ended must not seem to be done.
TEST(ParallelFor, BodiesDoNotGoOnAfterAnInnerLoopThatWasEnded) {
  for (const bool has_point : {false, true}) {
    std::optional<InterruptionPoint> point;
    if (has_point) {
      point.emplace([] {});
    }
    std::atomic<int> halves{0};
    EXPECT_THROW(parallelFor(4, 1, 0,
                             [&](std::size_t begin, std::size_t) {
                               if (begin == 3) {
                                 throw std::runtime_error("enough");
                               }
                               std::atomic<int> done{0};
                               parallelFor(2000, 1, 0, [&](std::size_t, std::size_t) {
                                 std::this_thread::sleep_for(std::chrono::microseconds(50));
                                 ++done;
                               });
                               halves += done < 2000 ? 1 : 0;
                             }),
                 std::runtime_error);
    EXPECT_EQ(halves, 0) << has_point;
  }
}

/// What the caller's interruption point throws, it throws once: a signal is told once.
TEST(WorkerInterruption, NothingThatIsThrownIsLostAtTheEndOfATask) {
  if (tbb::this_task_arena::max_concurrency() < 2) {
    GTEST_SKIP() << "one core";
  }
  EXPECT_TRUE(returns([] {
    for (int run = 0; run < 20; ++run) {
      const std::thread::id caller = std::this_thread::get_id();
      std::atomic<bool> begun{false}, is_told{false};
      int calls = 0;
      const InterruptionPoint point([&] {
        if (++calls == 2) {  // the caller has passed after its own range, and waits
          is_told = true;
          throw std::runtime_error("enough");
        }
      });
      const auto range = [&](std::size_t, std::size_t) {
        if (std::this_thread::get_id() == caller) {
          while (!begun) {
            std::this_thread::yield();
          }
          return;
        }
        begun = true;
        while (!is_told) {
          InterruptionPoint::pass();
        }
      };
      EXPECT_THROW(parallelFor(2, 1, 2, range), std::runtime_error) << run;
    }
  }));
}

}  // namespace
}  // namespace limitsurf
