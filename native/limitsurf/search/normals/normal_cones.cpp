// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/normals/normal_cones.h"

#include "limitsurf/parallel.h"
#include "limitsurf/search/normals/leaf_normals.h"

namespace limitsurf {
namespace {

/// More than the rounding of boxes and of places in them, in the unit of boxes.
constexpr double kLeastRadius = 1e-6;
/// The number of leaves that one task looks at.
constexpr std::size_t kLeavesPerTask = 64;

}  // namespace

NormalCones::NormalCones(const SearchTree& tree, int threads) : tree_(*tree.tree) {
  const LeafNormals normals(tree);
  std::vector<PieceNormals> leaves(tree.leaves.size());
  parallelFor(leaves.size(), kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      leaves[leaf] = normals.of(tree.leaves[leaf].piece);
    }
  });
  const std::int32_t count = tree_.nodeCount();
  children_.resize(WideTree::kWidth * static_cast<std::size_t>(count));
  // Children have higher numbers than their parents.
  for (std::int32_t number = count - 1; number >= 0; --number) {
    const WideTree::Node& node = tree_.node(number);
    for (int i = 0; i < node.count; ++i) {
      const std::int32_t child = node.children[i];
      if (WideTree::isLeaf(child)) {
        set(number, i, leaves[static_cast<std::size_t>(WideTree::leaf(child))]);
        continue;
      }
      PieceNormals all = of(child, 0);
      for (int j = 1; j < tree_.node(child).count; ++j) {
        all = PieceNormals::around(all, of(child, j));
      }
      set(number, i, all);
    }
  }
}

bool NormalCones::cannotFace(std::int32_t node, int child, const Vector3& point,
                             const Vector3& direction, double angle) const {
  Vector3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = tree_.node(node).bounds[axis][0][child];
    high[axis] = tree_.node(node).bounds[axis][1][child];
  }
  return of(node, child)
      .cannotFace(direction, angle, (low + high) / 2 - point,
                  (high - low).norm() / 2 + kLeastRadius);
}

PieceNormals NormalCones::of(std::int32_t node, int child) const {
  const Normals& kept = children_[place(node, child)];
  PieceNormals piece;
  piece.normals = kept.cone;
  piece.border = kept.border == kNoBorder        ? PieceNormals::Border::none
                 : kept.border == kUnknownBorder ? PieceNormals::Border::unknown
                                                 : PieceNormals::Border::smooth;
  if (piece.border == PieceNormals::Border::smooth) {
    piece.along_border = along_borders_[static_cast<std::size_t>(kept.border)];
  }
  return piece;
}

void NormalCones::set(std::int32_t node, int child, const PieceNormals& piece) {
  Normals& kept = children_[place(node, child)];
  kept.cone = piece.normals;
  kept.border = piece.border == PieceNormals::Border::none ? kNoBorder : kUnknownBorder;
  if (piece.border == PieceNormals::Border::smooth) {
    kept.border = static_cast<std::int32_t>(along_borders_.size());
    along_borders_.push_back(piece.along_border);
  }
}

}  // namespace limitsurf
