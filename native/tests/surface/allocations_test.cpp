// SPDX-License-Identifier: Apache-2.0
//
// Batch evaluation takes no memory for each row: what it takes for a task is bounded, whatever the
// faces are. This guards its speed without a clock.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/cages/benchmark_cages.h"
#include "support/cages/meshes.h"
#include "support/truth/witness.h"

namespace {

std::atomic<long> allocation_count{0};

}  // namespace

// All of this program's allocations by `new` are counted. Eigen's own go past it, by malloc(). If
// only some of these functions became inline, GCC would warn that malloc() and delete do not match.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocation_count;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace limitsurf::test {
namespace {

/// The allocations of one evaluation of `count` locations, which are sorted by face, on one thread.
long allocations(const LimitSurface& surface, int count, Derivatives derivatives) {
  Random random(3);
  std::vector<Location> at;
  for (int face = 0; face < surface.faceCount(); ++face) {
    at += anywhere(face, count / surface.faceCount(), random);
  }
  const auto rows = static_cast<Eigen::Index>(at.size());
  std::vector<Points> results(7, Points(rows, 3));
  const auto in = [&](int i) {
    return EvaluationArrays<double>::Rows{results[i].data(), at.size()};
  };
  const EvaluationArrays<double> arrays{in(0), in(1), in(2), in(3), in(4), in(5), in(6)};
  const long before = allocation_count;
  surface.evaluate(at, derivatives, arrays, 1);
  return allocation_count - before;
}

TEST(Allocations, DoNotGrowWithTheRowsOfATask) {
  constexpr int kRows = 2048 * 8, kTasks = 8;
  constexpr long kMost =
      24 * (kTasks + 1);  // for each task: some rows of memory per level of splits
  for (const Cage& cage : {perturbed(grid(8, 8), 0.2, 3), cross(), fan(11, true, 1), mixture(21)}) {
    const LimitSurface surface = limitSurface(cage);
    for (Derivatives derivatives : {Derivatives::none, Derivatives::first, Derivatives::second}) {
      EXPECT_LE(allocations(surface, kRows, derivatives), kMost);
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
