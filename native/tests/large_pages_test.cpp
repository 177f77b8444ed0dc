// SPDX-License-Identifier: Apache-2.0
//
// Memory in large pages holds what is written to it, whatever its size.
#include "limitsurf/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "limitsurf/types.h"

namespace limitsurf::test {
namespace {

TEST(LargePages, HoldVectorsOfAnySize) {
  for (const std::size_t count : {0, 1, 1000, (1 << 17) - 1, 1 << 17, 1 << 18, 1'000'003}) {
    LargePageVector<std::int32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    LargePageVector<std::int32_t> copy = numbers;
    numbers.push_back(-1);  // moves them
    EXPECT_EQ(numbers.size(), count + 1);
    EXPECT_TRUE(std::equal(copy.begin(), copy.end(), numbers.begin())) << count;
    const LargePageVector<std::int32_t> taken = std::move(copy);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(taken[i], static_cast<std::int32_t>(i));
    }
  }
}

TEST(LargePages, KeepTheAlignmentOfTheElements) {
  struct alignas(64) Line {
    double numbers[8];
  };
  for (const std::size_t count : {1, 100, 100'000}) {
    const LargePageVector<Line> lines(count);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.data()) % 64, 0u) << count;
  }
}

TEST(LargePages, MayBeAskedForWithoutThem) {
  askForLargePages(nullptr, 0);
  Points points;
  for (const std::size_t rows : {0, 1, 1'000'003, 2}) {
    resizeRows(points, rows);
    points.setConstant(7);
    EXPECT_EQ(points.rows(), static_cast<Eigen::Index>(rows));
    EXPECT_EQ(points.sum(), 21. * static_cast<double>(rows));
  }
}

}  // namespace
}  // namespace limitsurf::test
