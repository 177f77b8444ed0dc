// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/tree/tree_part.h"
#include "limitsurf/search/wide_tree.h"

namespace limitsurf {

/// Oriented boxes around some of a node's children.
struct CloserBoxes {
  LeafBox boxes[WideTree::kWidth];
  unsigned children = 0;  ///< a bit for each child that has one

  void set(int child, const LeafBox& box) {
    boxes[child] = box;
    children |= 1u << child;
  }
};

/// Oriented boxes around the long and narrow ones among the nests of a tree.
struct NestBoxes {
  std::vector<LeafBox> boxes;
  std::vector<std::int32_t> of_nest;  ///< the box of each nest, or -1

  const LeafBox* find(std::size_t nest) const {
    return of_nest[nest] < 0 ? nullptr : &boxes[of_nest[nest]];
  }
};

/// Makes boxes for the children of those nodes over which the tree's own boxes, along the
/// coordinate axes, are nearly empty: over long and narrow faces that lie aslant. Around a pole, as
/// an example, most points of the surface lie in the boxes of a large part of all faces, but in few
/// oriented ones. Sets WideTree::Node::closer.
std::vector<CloserBoxes> makeCloserBoxes(LargePageVector<WideTree::Node>& nodes,
                                         const LargePageVector<SearchLeaf>& leaves,
                                         const NestBoxes& nests);

}  // namespace limitsurf
