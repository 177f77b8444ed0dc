// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/foot_bound.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/wide_tree.h"
#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// A leaf of the search tree: a bicubic patch, or a core, which searches split when they reach it.
/// All cores around a vertex with many faces are one leaf, at the place of the first of them.
struct SearchLeaf {
  LeafBox box;
  SurfacePiece piece;
  FootBound foot_bound;  ///< of a patch
};

/// A part of the search tree that is made at once: its top, or what is below one Ptex face.
struct TreePart {
  Span<WideTree::Node> nodes;  ///< the root first; children have higher numbers
  Span<SearchLeaf> leaves;     ///< in the order of the tree
  /// The patches of the leaves, or none if they would need too much memory; those of cores are not
  /// set.
  Span<BezierPatch> kept;
};

/// The same, just made.
struct BuiltPart {
  LargePageVector<WideTree::Node> nodes;
  std::vector<SearchLeaf> leaves;
  std::vector<BezierPatch> patches;  ///< of the leaves; those of cores are not set
};

}  // namespace limitsurf
