// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/tree/tree_part.h"
#include "limitsurf/search/wide_tree.h"

namespace limitsurf {

/// Oriented boxes around some of a node's children.
struct CloserBoxes {
  LeafBox boxes[WideTree::kWidth];
  unsigned children = 0;  ///< a bit for each child that has one
};

/// Makes boxes for the children of those nodes over which the tree's own boxes, along the
/// coordinate axes, are nearly empty: over long and narrow faces that lie aslant. Around a pole, as
/// an example, most points of the surface lie in the boxes of a large part of all faces, but in few
/// oriented ones. Sets WideTree::Node::closer.
std::vector<CloserBoxes> makeCloserBoxes(LargePageVector<WideTree::Node>& nodes,
                                         const LargePageVector<SearchLeaf>& leaves);

}  // namespace limitsurf
