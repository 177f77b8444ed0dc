// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/patches/surface_patches.h"
#include "limitsurf/unset_vector.h"

namespace limitsurf {

/// An axis-aligned box in single precision, rounded outwards.
struct BoxF {
  using Corner = Eigen::Array4f;  // padded to a register; the fourth is 0
  Corner low, high;

  BoxF() = default;  ///< not set
  static BoxF empty();
  explicit BoxF(const Box& box);
  void include(const BoxF& box);
  /// Half of the area of its surface.
  float halfArea() const;
};

/// A binary tree of axis-aligned boxes, a bounding volume hierarchy, over leaves that the caller
/// keeps. It is built by the surface area heuristic in bins (Wald: "On fast Construction of
/// SAH-based Bounding Volume Hierarchies", 2007).
class BoxTree {
 public:
  struct Node {
    BoxF boxes[2];
    std::int32_t children[2];  ///< a node's number, or ~(a leaf's place in the order of leaves)
  };

  /// Sets `order` to the numbers of the leaves, in the order in which the tree refers to them. The
  /// tree does not depend on the number of threads. Must not be called from within a parallel loop.
  BoxTree(const std::vector<BoxF>& leaves, std::vector<std::int32_t>& order, int threads = 0);

  bool empty() const { return nodes_.empty(); }
  const Node& node(std::int32_t i) const { return nodes_[i]; }
  /// A node over some leaves comes before the nodes below it, which are one less than its leaves:
  /// first those below its first child, then those below its second one.
  std::int32_t nodeCount() const { return static_cast<std::int32_t>(nodes_.size()); }
  std::int32_t leafCount() const { return leaf_count_; }
  static bool isLeaf(std::int32_t child) { return child < 0; }
  static std::int32_t leaf(std::int32_t child) { return ~child; }

  /// The number of nodes on the longest path from the root.
  static constexpr int kMostDepth = 64;

 private:
  class Builder;
  std::int32_t leaf_count_;
  UnsetVector<Node> nodes_;  ///< the root first; over a single leaf its second box is empty
};

}  // namespace limitsurf
