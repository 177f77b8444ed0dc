// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/part_array.h"

#include <gtest/gtest.h>

#include <numeric>

namespace limitsurf {
namespace {

TEST(PartArray, KeepsElementsNextToEachOther) {
  PartArray<int> array;
  std::vector<std::size_t> first;
  std::vector<int> run(100'000);
  std::iota(run.begin(), run.end(), 0);
  for (int i = 0; i < 10; ++i) {
    first.push_back(array.append(run.data(), run.size() - i));
  }
  EXPECT_GT(array.size(), 10 * run.size() - 45);  // 1 MiB has room for two of them
  for (int i = 0; i < 10; ++i) {
    const int* const begin = &array[first[i]];
    EXPECT_TRUE(std::equal(run.begin(), run.end() - i, begin)) << i;
  }
}

TEST(PartArray, DoesNotMoveFullParts) {
  PartArray<int> array;
  const int limit = 1 << 18;  // of a part
  for (int i = 0; i < limit; ++i) {
    array.push_back(i);
  }
  const int* const first = &array[0];
  for (int i = limit; i < 5 * limit; ++i) {
    array.push_back(i);
  }
  array.shrink();
  EXPECT_EQ(&array[0], first);
  EXPECT_EQ(array.size(), 5u * limit);
  std::vector<int> all;
  all.reserve(array.size());
  array.moveTo(all);
  EXPECT_EQ(array.size(), 0u);
  for (int i = 0; i < 5 * limit; ++i) {
    ASSERT_EQ(all[i], i);
  }
}

TEST(PartArray, RefusesMoreNeighboursThanAPartHolds) {
  PartArray<int> array;
  const std::vector<int> run((std::size_t{1} << 18) + 1);
  EXPECT_THROW(array.append(run.data(), run.size()), std::length_error);
}

}  // namespace
}  // namespace limitsurf
