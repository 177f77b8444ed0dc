// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/wide_tree.h"

#include <limits>

namespace limitsurf {

class WideTree::Builder {
 public:
  Builder(const BoxTree& tree, std::vector<Node>& nodes) : tree_(tree), nodes_(nodes) {}

  /// Adds the node for one of the binary tree and all nodes below it. Returns its number.
  std::int32_t add(std::int32_t binary) {
    Child children[kWidth];
    const int count = gather(binary, children);
    const auto index = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    Node& node = nodes_.back();
    node.count = count;
    for (int axis = 0; axis < 3; ++axis) {
      Row &low = node.bounds[axis][0], &high = node.bounds[axis][1];
      low.setConstant(std::numeric_limits<float>::infinity());
      high = -low;
      for (int i = 0; i < count; ++i) {
        low[i] = children[i].box.low[axis];
        high[i] = children[i].box.high[axis];
      }
    }
    for (int i = 0; i < kWidth; ++i) {
      const std::int32_t child = i < count ? children[i].place : ~0;
      const std::int32_t own = BoxTree::isLeaf(child) ? child : add(child);
      nodes_[static_cast<std::size_t>(index)].children[i] = own;
    }
    return index;
  }

 private:
  struct Child {
    BoxF box;
    std::int32_t place;  ///< in the binary tree
  };

  static Child childOf(const BoxTree::Node& node, int side) {
    return {node.boxes[side], node.children[side]};
  }

  /// The descendants of a node that become the children of a wide one, in the order of their
  /// leaves: the node in the largest box gives way to its children, until there are enough.
  int gather(std::int32_t binary, Child out[kWidth]) const {
    const BoxTree::Node& node = tree_.node(binary);
    out[0] = childOf(node, 0);
    out[1] = childOf(node, 1);
    int count = node.boxes[1].low[0] > node.boxes[1].high[0] ? 1 : 2;  // one of them may be empty
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
      const BoxTree::Node& opened = tree_.node(out[largest].place);
      for (int i = count; i > largest + 1; --i) {
        out[i] = out[i - 1];
      }
      out[largest] = childOf(opened, 0);
      out[largest + 1] = childOf(opened, 1);
      ++count;
    }
    return count;
  }

  const BoxTree& tree_;
  std::vector<Node>& nodes_;
};

WideTree::WideTree(const BoxTree& tree) {
  if (!tree.empty()) {
    nodes_.reserve(static_cast<std::size_t>(tree.nodeCount()) / 2 + 1);
    Builder(tree, nodes_).add(0);
    nodes_.shrink_to_fit();
  }
}

}  // namespace limitsurf
