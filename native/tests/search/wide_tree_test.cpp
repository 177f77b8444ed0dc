// SPDX-License-Identifier: Apache-2.0
//
// The tree of four children: it has every leaf of the binary tree once, in boxes that contain it;
// and what a walk has still to visit comes nearest first.
#include "limitsurf/search/wide_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"

namespace limitsurf::test {
namespace {

using Boxes = std::vector<BoxF>;

struct Walk {
  std::vector<int> seen;
  int nodes = 0;
};

void visit(const WideTree& tree, std::int32_t index, const BoxF& around, const Boxes& boxes,
           const std::vector<std::int32_t>& order, Walk& walk) {
  const WideTree::Node& node = tree.nodes()[static_cast<std::size_t>(index)];
  ++walk.nodes;
  EXPECT_GE(node.count, boxes.size() > 1 ? 2 : 1);
  EXPECT_LE(node.count, WideTree::kWidth);
  for (int i = 0; i < node.count; ++i) {
    BoxF own = BoxF::empty();
    for (int axis = 0; axis < 3; ++axis) {
      own.low[axis] = node.bounds[axis][0][i];
      own.high[axis] = node.bounds[axis][1][i];
      EXPECT_GE(own.low[axis], around.low[axis]);
      EXPECT_LE(own.high[axis], around.high[axis]);
    }
    const std::int32_t child = node.children[i];
    if (WideTree::isLeaf(child)) {
      const auto leaf =
          static_cast<std::size_t>(order.at(static_cast<std::size_t>(WideTree::leaf(child))));
      EXPECT_TRUE((own.low <= boxes[leaf].low).all() && (own.high >= boxes[leaf].high).all());
      ++walk.seen.at(leaf);
    } else {
      EXPECT_GT(child, index);
      visit(tree, child, own, boxes, order, walk);
    }
  }
}

TEST(WideTree, HasEveryLeafOnceInItsBoxes) {
  Random random(1);
  for (const int count : {0, 1, 2, 3, 4, 5, 17, 1000, 20000, 40000}) {
    Boxes boxes;
    BoxF around = BoxF::empty();
    for (int i = 0; i < count; ++i) {
      const Vector3 low = random.vector(1);
      boxes.emplace_back(Box{low, low + 0.01 * (random.vector(1) + Vector3::Ones())});
      around.include(boxes.back());
    }
    std::vector<std::int32_t> order;
    const WideTree tree(BoxTree(boxes, order));
    EXPECT_EQ(tree.nodes().empty(), count == 0);
    if (count == 0) continue;
    Walk walk;
    walk.seen.assign(boxes.size(), 0);
    visit(tree, 0, around, boxes, order, walk);
    EXPECT_EQ(std::count(walk.seen.begin(), walk.seen.end(), 1), count);
    EXPECT_EQ(static_cast<std::size_t>(walk.nodes), tree.nodes().size());
    if (count >= 1000) {  // nodes are nearly full
      EXPECT_LE(walk.nodes, count / 2);
    }
  }
}

/// Enough leaves that threads share them.
TEST(WideTree, DoesNotDependOnTheNumberOfThreads) {
  Random random(3);
  Boxes boxes;
  for (int i = 0; i < 50000; ++i) {
    const Vector3 low = random.vector(1);
    boxes.emplace_back(Box{low, low + 0.01 * (random.vector(1) + Vector3::Ones())});
  }
  std::vector<std::int32_t> order, other_order;
  const WideTree tree(BoxTree(boxes, order, 1), 1), other(BoxTree(boxes, other_order, 0), 0);
  EXPECT_EQ(order, other_order);
  ASSERT_EQ(tree.nodes().size(), other.nodes().size());
  for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
    const WideTree::Node &a = tree.nodes()[i], &b = other.nodes()[i];
    EXPECT_EQ(a.count, b.count);
    EXPECT_TRUE(std::equal(a.children, a.children + WideTree::kWidth, b.children));
    for (int axis = 0; axis < 3; ++axis) {
      for (int end = 0; end < 2; ++end) {
        EXPECT_TRUE((a.bounds[axis][end] == b.bounds[axis][end]).all());
      }
    }
  }
}

TEST(WideTree, NearestFirstKeepsTheOrderOfNearness) {
  Random random(2);
  for (int round = 0; round < 1000; ++round) {
    NearestFirst open;
    WideTree::Node node{};
    node.count = 1 + random.below(4);
    WideTree::Row keys, nearness;
    std::vector<std::pair<float, NearestFirst::Entry>> expected;
    bool matters[4];
    for (int i = 0; i < 4; ++i) {
      node.children[i] = 10 + i;
      keys[i] = static_cast<float>(random.uniform());
      nearness[i] = static_cast<float>(random.below(5) - 2);  // often equal, often negative
      matters[i] = random.below(3) > 0;
      if (i < node.count && matters[i]) {
        expected.push_back({nearness[i], {node.children[i], keys[i], round}});
      }
    }
    std::stable_sort(expected.begin(), expected.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    open.add(node, keys, nearness,
             WideTree::children(node, [&](int child) { return matters[child]; }), round);
    NearestFirst::Entry next;
    for (const auto& [near, entry] : expected) {
      ASSERT_TRUE(open.take(next));
      EXPECT_EQ(next.place, entry.place);
      EXPECT_EQ(next.key, entry.key);
      EXPECT_EQ(next.part, round);
    }
    EXPECT_FALSE(open.take(next));
  }
}

}  // namespace
}  // namespace limitsurf::test
