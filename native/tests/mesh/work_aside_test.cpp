// SPDX-License-Identifier: Apache-2.0
//
// Work that knows of no interruption points is done aside: calls that wait for it can be ended at
// once, whatever becomes of the work.
#include "limitsurf/work_aside.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <future>
#include <memory>
#include <stdexcept>

#if !defined(_WIN32)
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace limitsurf::test {
namespace {

struct Interrupted {};

TEST(WorkAside, GivesResultsAndErrors) {
  EXPECT_EQ(*workAside([] { return std::make_unique<int>(7); }), 7);
  EXPECT_THROW(workAside([]() -> int { throw std::invalid_argument("no"); }),
               std::invalid_argument);
}

TEST(WorkAside, PassesInterruptionPointsWhileItWorks) {
  auto passes = std::make_shared<std::atomic<int>>(0);
  const InterruptionPoint point([passes] { ++*passes; });
  const int seen = workAside([passes] {
    while (*passes < 3) {
      std::this_thread::yield();
    }
    return passes->load();
  });
  EXPECT_GE(seen, 3);
}

/// A call that is ended while its work waits for a word from outside.
TEST(WorkAside, WorkThatNobodyWaitsForEndsOnItsOwnAndIsForgotten) {
  auto word = std::make_shared<std::promise<void>>();
  auto done = std::make_shared<std::promise<int>>();
  std::future<int> last = done->get_future();
  auto data = std::make_shared<const std::vector<int>>(1000, 3);
  const std::weak_ptr<const std::vector<int>> kept = data;
  {
    const InterruptionPoint point([] { throw Interrupted(); });
    EXPECT_THROW(workAside([go = word->get_future().share(), done, data = std::move(data)] {
                   go.wait();
                   done->set_value((*data)[999]);
                   return 0;
                 }),
                 Interrupted);
  }
  EXPECT_FALSE(kept.expired());  // the work still runs, and has its data
  word->set_value();
  EXPECT_EQ(last.get(), 3);
  while (!kept.expired()) {
    std::this_thread::yield();
  }
}

TEST(WorkAside, ProcessesDoNotWaitForItAtTheirEnd) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto end = [] {
    const InterruptionPoint point([] { throw Interrupted(); });
    try {
      workAside([] {
        for (std::vector<int> data(1000);; data.assign(1000, 0)) {
          std::this_thread::yield();
        }
        return 0;
      });
    } catch (const Interrupted&) {
      std::exit(7);
    }
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(7), "");
}

#if !defined(_WIN32)
TEST(WorkAside, ForkedChildrenDoItThemselves) {
  const pid_t parent = getpid();
  pid_t child = -1;
  auto forked = std::make_shared<std::atomic<bool>>(false);
  const InterruptionPoint point([&] {
    if (child < 0) {
      child = fork();
      *forked = true;
    }
  });
  const int result = workAside([forked] {
    while (!*forked) {
      std::this_thread::yield();
    }
    return 5;
  });
  if (getpid() != parent) {
    _exit(result);
  }
  EXPECT_EQ(result, 5);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 5);
}
#endif

}  // namespace
}  // namespace limitsurf::test
