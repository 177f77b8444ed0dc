// SPDX-License-Identifier: Apache-2.0
//
// The tree of boxes: it has every leaf once, in boxes that contain it, and is never too deep.
#include "limitsurf/search/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "support/random.h"

namespace limitsurf::test {
namespace {

using Boxes = std::vector<BoxF>;

BoxF box(const Vector3& low, const Vector3& high) { return BoxF(Box{low, high}); }

bool holds(const BoxF& outer, const BoxF& inner) {
  for (int i = 0; i < 3; ++i) {
    if (!(outer.low[i] <= inner.low[i] && outer.high[i] >= inner.high[i])) return false;
  }
  return true;
}

struct Walk {
  std::vector<int> seen;
  int depth = 0;
  int nodes = 0;
};

void visit(const BoxTree& tree, std::int32_t index, const BoxF& around, const Boxes& boxes,
           const std::vector<std::int32_t>& order, int depth, Walk& walk) {
  const BoxTree::Node& node = tree.node(index);
  walk.depth = std::max(walk.depth, depth);
  ++walk.nodes;
  for (int side = 0; side < 2; ++side) {
    const BoxF& own = node.boxes[side];
    if (own.low[0] > own.high[0]) continue;  // empty
    EXPECT_TRUE(holds(around, own));
    const std::int32_t child = node.children[side];
    if (BoxTree::isLeaf(child)) {
      const std::int32_t leaf = order.at(static_cast<std::size_t>(BoxTree::leaf(child)));
      EXPECT_TRUE(holds(own, boxes[static_cast<std::size_t>(leaf)]));
      ++walk.seen.at(static_cast<std::size_t>(leaf));
    } else {
      visit(tree, child, own, boxes, order, depth + 1, walk);
    }
  }
}

void expectSound(const std::string& name, const Boxes& boxes) {
  std::vector<std::int32_t> order;
  const BoxTree tree(boxes, order);
  std::vector<std::int32_t> sorted = order, all(boxes.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all) << name;
  EXPECT_EQ(tree.empty(), boxes.empty()) << name;
  if (boxes.empty()) return;
  BoxF around = BoxF::empty();
  for (const BoxF& b : boxes) around.include(b);
  Walk walk;
  walk.seen.assign(boxes.size(), 0);
  visit(tree, 0, around, boxes, order, 1, walk);
  EXPECT_EQ(std::count(walk.seen.begin(), walk.seen.end(), 1),
            static_cast<std::ptrdiff_t>(boxes.size()))
      << name;
  EXPECT_LE(walk.depth, BoxTree::kMostDepth) << name;
  EXPECT_EQ(walk.nodes, std::max(1, static_cast<int>(boxes.size()) - 1)) << name;
}

Boxes randomBoxes(int count, double size, double scale, std::uint64_t seed) {
  Random random(seed);
  Boxes boxes;
  for (int i = 0; i < count; ++i) {
    const Vector3 low = random.vector(1), high = low + size * (random.vector(1) + Vector3::Ones());
    boxes.push_back(box(scale * low, scale * high));
  }
  return boxes;
}

TEST(BoxTree, HasEveryLeafOnceInItsBoxes) {
  for (const int count : {0, 1, 2, 3, 10, 1000, 4097, 20000}) {
    expectSound(std::to_string(count), randomBoxes(count, 0.01, 1, 1));
  }
  for (const double scale : {1e-45, 1e-38, 1e-30, 1e-20, 1e20, 1e30, 1e38}) {
    expectSound("scale " + std::to_string(scale), randomBoxes(500, 0.1, scale, 2));
  }
}

TEST(BoxTree, IsNeverTooDeep) {
  // Leaves that a heuristic may split off one by one: equal boxes, nested boxes, exponential rows.
  Boxes equal(5000, box({0, 0, 0}, {1, 1, 1}));
  expectSound("equal", equal);
  Boxes points(3000, box({1, 2, 3}, {1, 2, 3}));
  expectSound("points", points);
  Boxes nested, row, spiral;
  for (int i = 0; i < 3000; ++i) {
    const double size = 1 + i;
    nested.push_back(box(-size * Vector3::Ones(), size * Vector3::Ones()));
    const double at = std::ldexp(1., i % 120);
    row.push_back(box({at, 0, 0}, {at * 1.5, 1e-3, 1e-3}));
    spiral.push_back(
        box(std::pow(0.98, i) * Vector3::Ones(), std::pow(0.98, i) * Vector3(2, 2, 2)));
  }
  expectSound("nested", nested);
  expectSound("row", row);
  expectSound("spiral", spiral);
}

TEST(BoxTree, SinglePrecisionIsRoundedOutwards) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const double scale = std::pow(10., random.uniform(-44, 38));
    const Vector3 low = scale * random.vector(1), high = low + scale * Vector3::Ones();
    const BoxF rounded = box(low, high);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(static_cast<double>(rounded.low[axis]), low[axis]);
      EXPECT_GE(static_cast<double>(rounded.high[axis]), high[axis]);
    }
  }
}

}  // namespace
}  // namespace limitsurf::test
