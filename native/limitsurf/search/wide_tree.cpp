// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/wide_tree.h"

#include <algorithm>
#include <limits>

#include "limitsurf/parallel.h"

namespace limitsurf {

class WideTree::Builder {
 public:
  explicit Builder(const BoxTree& tree) : tree_(tree) {}

  /// The nodes at the top are gathered first, then those below each of them by one thread each.
  void build(LargePageVector<Node>& nodes, int threads) {
    if (tree_.leafCount() <= kLeavesPerTask) {
      nodes.reserve(static_cast<std::size_t>(tree_.leafCount()) / 2 + 1);
      add(0, tree_.leafCount(), nullptr, nodes);
      return;
    }
    LargePageVector<Node> top;
    add(0, tree_.leafCount(), &parts_, top);
    std::vector<LargePageVector<Node>> below(parts_.size());
    parallelFor(parts_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        add(parts_[i].place, parts_[i].leaves, nullptr, below[i]);
      }
    });
    std::vector<std::int32_t> first{static_cast<std::int32_t>(top.size())};
    for (const LargePageVector<Node>& part : below) {
      first.push_back(first.back() + static_cast<std::int32_t>(part.size()));
    }
    nodes.resize(static_cast<std::size_t>(first.back()));
    copy(top, nodes.data(), [&](std::int32_t child) {
      return child < kPart ? child : first[static_cast<std::size_t>(child - kPart)];
    });
    parallelFor(parts_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        copy(below[i], nodes.data() + first[i],
             [&](std::int32_t child) { return first[i] + child; });
        below[i] = {};
      }
    });
  }

 private:
  /// The leaves under a node that is left to one thread: a millisecond.
  static constexpr std::int32_t kLeavesPerTask = 1 << 13;
  /// The number of a child at the top that is the first node of a part: this and the part's number.
  static constexpr std::int32_t kPart = std::int32_t{1} << 30;

  /// A node of the binary tree, or one of its leaves.
  struct Child {
    BoxF box;
    std::int32_t place;   ///< as BoxTree::Node::children
    std::int32_t leaves;  ///< the number of leaves under it
  };

  /// Adds the node for one of the binary tree, which is over so many leaves, and all nodes below
  /// it. With `parts`, nodes over kLeavesPerTask leaves or fewer are put there in place of being
  /// added. Returns the node's number.
  std::int32_t add(std::int32_t binary, std::int32_t leaves, std::vector<Child>* parts,
                   LargePageVector<Node>& nodes) const {
    Child children[kWidth];
    const int count = gather(binary, leaves, children);
    const auto index = static_cast<std::int32_t>(nodes.size());
    BoxF boxes[kWidth];
    std::int32_t places[kWidth];
    for (int i = 0; i < count; ++i) {
      boxes[i] = children[i].box;
      places[i] = children[i].place;
    }
    nodes.push_back(nodeOver(boxes, places, count));
    for (int i = 0; i < count; ++i) {
      std::int32_t child = places[i];
      if (!BoxTree::isLeaf(child)) {
        if (parts && children[i].leaves <= kLeavesPerTask) {
          child = kPart + static_cast<std::int32_t>(parts->size());
          parts->push_back(children[i]);
        } else {
          child = add(child, children[i].leaves, parts, nodes);
        }
      }
      nodes[static_cast<std::size_t>(index)].children[i] = child;
    }
    return index;
  }

  /// Sets the two children of a node that is over so many leaves.
  void open(std::int32_t binary, std::int32_t leaves, Child& low, Child& high) const {
    const BoxTree::Node& node = tree_.node(binary);
    const std::int32_t first = BoxTree::isLeaf(node.children[0])   ? 1
                               : BoxTree::isLeaf(node.children[1]) ? leaves - 1
                                                                   : node.children[1] - binary;
    low = {node.boxes[0], node.children[0], first};
    high = {node.boxes[1], node.children[1], leaves - first};
  }

  /// The descendants of a node that become the children of a wide one, in the order of their
  /// leaves: the node in the largest box gives way to its children, until there are enough.
  int gather(std::int32_t binary, std::int32_t leaves, Child out[kWidth]) const {
    open(binary, leaves, out[0], out[1]);
    int count = leaves == 1 ? 1 : 2;  // over a single leaf the second box is empty
    while (count < kWidth) {
      int largest = -1;
      for (int i = 0; i < count; ++i) {
        if (!BoxTree::isLeaf(out[i].place) &&
            (largest < 0 || out[i].box.halfArea() > out[largest].box.halfArea())) {
          largest = i;
        }
      }
      if (largest < 0) {
        break;
      }
      const Child opened = out[largest];
      for (int i = count; i > largest + 1; --i) {
        out[i] = out[i - 1];
      }
      open(opened.place, opened.leaves, out[largest], out[largest + 1]);
      ++count;
    }
    return count;
  }

  /// Copies nodes, with their children's numbers as `moved(number)`; leaves stay as they are.
  template <typename Moved>
  static void copy(const LargePageVector<Node>& from, Node* to, const Moved& moved) {
    for (const Node& node : from) {
      *to = node;
      for (std::int32_t& child : to->children) {
        child = isLeaf(child) ? child : moved(child);
      }
      ++to;
    }
  }

  const BoxTree& tree_;
  std::vector<Child> parts_;
};

WideTree::Node WideTree::nodeOver(const BoxF boxes[], const std::int32_t children[], int count) {
  Node node;
  node.count = count;
  node.closer = -1;
  for (int axis = 0; axis < 3; ++axis) {
    Row &low = node.bounds[axis][0], &high = node.bounds[axis][1];
    low.setConstant(std::numeric_limits<float>::infinity());
    high = -low;
    for (int i = 0; i < count; ++i) {
      low[i] = boxes[i].low[axis];
      high[i] = boxes[i].high[axis];
    }
  }
  std::fill_n(std::copy_n(children, count, node.children), kWidth - count, ~0);
  return node;
}

WideTree::WideTree(const BoxTree& tree, int threads) {
  if (!tree.empty()) {
    Builder(tree).build(nodes_, threads);
  }
}

}  // namespace limitsurf
