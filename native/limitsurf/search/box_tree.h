// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/surface/surface_patches.h"

namespace limitsurf {

/// A box in single precision, rounded outwards.
struct BoxF {
  using Corner = Eigen::Array4f;  // padded to a register; the fourth is 0
  Corner low, high;

  BoxF();  ///< empty
  explicit BoxF(const Box& box);
  void include(const BoxF& box);
  /// Half of its surface.
  float halfArea() const;
};

/// A binary tree of boxes over leaves that somebody else keeps, built by the surface area heuristic
/// (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies").
class BoxTree {
 public:
  struct Node {
    BoxF boxes[2];
    std::int32_t children[2];  ///< a node, or ~(position in the order of leaves)
  };

  /// `order` gets the leaves' numbers in the order in which the tree refers to them.
  BoxTree(const std::vector<BoxF>& leaves, std::vector<std::int32_t>& order);

  bool empty() const { return nodes_.empty(); }
  const Node& node(std::int32_t i) const { return nodes_[i]; }
  static bool isLeaf(std::int32_t child) { return child < 0; }
  static std::int32_t leaf(std::int32_t child) { return ~child; }

  /// No path from the root has more nodes.
  static constexpr int kMostDepth = 64;

 private:
  class Builder;
  std::vector<Node> nodes_;  ///< the root first; one with a single leaf has an empty second box
};

}  // namespace limitsurf
