// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "limitsurf/large_pages.h"
#include "limitsurf/search/box_tree.h"

namespace limitsurf {

/// A box tree in which a node has up to four children, so that a search tests four boxes with the
/// same instructions and meets fewer nodes.
class WideTree {
 public:
  static constexpr int kWidth = 4;
  /// One number for each child of a node.
  using Row = Eigen::Array<float, kWidth, 1>;

  struct Node {
    Row bounds[3][2];  ///< the low and the high ends of the children's boxes, axis by axis
    std::int32_t
        children[kWidth];  ///< a node's number, or ~(a leaf's place in the order of leaves)
    std::int32_t count;    ///< the number of children, which come first
    /// The place of boxes that fit the children more closely, where the search tree has such boxes;
    /// -1 if there are none.
    std::int32_t closer;
  };

  /// The same leaves in the same order, in the same boxes. The tree does not depend on the number
  /// of threads. Must not be called from within a parallel loop.
  explicit WideTree(const BoxTree& tree, int threads = 0);

  /// The root first; children have higher numbers than their parents.
  const LargePageVector<Node>& nodes() const { return nodes_; }
  LargePageVector<Node> takeNodes() { return std::move(nodes_); }
  static bool isLeaf(std::int32_t child) { return child < 0; }
  static std::int32_t leaf(std::int32_t child) { return ~child; }

  /// A node over some boxes, one to four.
  static Node nodeOver(const BoxF boxes[], const std::int32_t children[], int count);

  /// A bit for each child of a node for which `matters(child)`.
  template <typename Matters>
  static unsigned children(const Node& node, const Matters& matters) {
    unsigned bits = 0;
    for (int child = 0; child < kWidth; ++child) {
      bits |= static_cast<unsigned>((child < node.count) & matters(child)) << child;
    }
    return bits;
  }

 private:
  class Builder;
  LargePageVector<Node> nodes_;
};

/// What a walk down a tree has still to visit. The last one added of those that are nearest among
/// their siblings comes first, so that the walk goes to the nearest leaves early.
class NearestFirst {
 public:
  struct Entry {
    std::int32_t place;  ///< as WideTree::Node::children
    float key;           ///< how near it is
    std::int32_t part;   ///< the tree of which it is a node or a leaf, if there are several
  };

  /// A walk puts all children but one aside at each node. The longest way leads through a BoxTree
  /// and then as many nodes below.
  static constexpr int kMostOpen = (WideTree::kWidth - 1) * 2 * BoxTree::kMostDepth + 1;

  /// Adds those children of a node of a part that have a bit in `bits`. The one with the least
  /// `nearness` will be taken first.
  void add(const WideTree::Node& node, const WideTree::Row& keys, const WideTree::Row& nearness,
           unsigned bits, std::int32_t part) {
    static_assert(WideTree::kWidth == 4, "a network that sorts four");
    if ((bits & (bits - 1)) == 0) {  // there is one, as at most nodes, or none
      const auto child = static_cast<int>((bits >> 1) - (bits >> 3));
      entries_[height_] = {node.children[child], keys[child], part};
      height_ += bits != 0 ? 1 : 0;
      return;
    }
    // Which child is nearer is hard to predict, so that they are sorted without branches: by
    // numbers that grow with the nearness and then the place among the children.
    std::uint64_t order[4];
    for (int child = 0; child < 4; ++child) {
      const std::uint64_t number = static_cast<std::uint64_t>(ordered(nearness[child])) << 32 |
                                   static_cast<std::uint64_t>(child);
      order[child] = (bits >> child & 1) != 0 ? number : kNone;
    }
    sortTwo(order[0], order[1]);
    sortTwo(order[2], order[3]);
    sortTwo(order[0], order[2]);
    sortTwo(order[1], order[3]);
    sortTwo(order[1], order[2]);
    for (int i = 3; i >= 0; --i) {
      const auto child = static_cast<int>(order[i] & 3);
      entries_[height_] = {node.children[child], keys[child], part};
      height_ += order[i] != kNone ? 1 : 0;
    }
  }

  void clear() { height_ = 0; }

  /// Takes the next one. Returns false if there is none.
  bool take(Entry& next) {
    if (height_ == 0) {
      return false;
    }
    next = entries_[--height_];
    return true;
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  /// A number that grows with a float that is not NaN.
  static std::uint32_t ordered(float key) {
    std::uint32_t bits;
    std::memcpy(&bits, &key, sizeof bits);
    return bits >> 31 != 0 ? ~bits : bits | 0x80000000u;
  }
  static void sortTwo(std::uint64_t& a, std::uint64_t& b) {
    const std::uint64_t less = std::min(a, b);
    b = std::max(a, b);
    a = less;
  }

  Entry entries_[kMostOpen];
  int height_ = 0;
};

}  // namespace limitsurf
