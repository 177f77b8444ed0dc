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

NormalCones::NormalCones(const SearchTree& tree, int threads) : tree_(tree) {
  const auto nests = static_cast<std::size_t>(tree.nestCount());
  const auto partOf = [&](std::size_t i) -> const TreePart& {
    return i == 0 ? tree.top() : tree.nest(static_cast<std::int32_t>(i - 1));
  };
  tree.makeAllNests(threads);
  first_.push_back(0);
  std::vector<const SurfacePiece*> pieces;
  std::vector<std::size_t> first_leaves{0};
  for (std::size_t i = 0; i <= nests; ++i) {
    const TreePart& part = partOf(i);
    first_.push_back(first_.back() + part.nodes.size());
    for (const SearchLeaf& leaf : part.leaves) {
      pieces.push_back(&leaf.piece);
    }
    first_leaves.push_back(pieces.size());
  }
  const LeafNormals normals(tree);
  std::vector<PieceNormals> leaves(pieces.size());
  parallelFor(leaves.size(), kLeavesPerTask, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      leaves[leaf] = normals.of(*pieces[leaf]);
    }
  });
  children_.resize(WideTree::kWidth * first_.back());
  for (std::size_t i = nests + 1; i-- > 0;) {  // the top last
    setPart(static_cast<std::int32_t>(i) + SearchTree::kTop, leaves.data() + first_leaves[i]);
  }
}

void NormalCones::setPart(std::int32_t number, const PieceNormals leaves[]) {
  const TreePart& part = number == SearchTree::kTop ? tree_.top() : tree_.nest(number);
  // Children have higher numbers than their parents.
  for (std::size_t i = part.nodes.size(); i-- > 0;) {
    const WideTree::Node& node = part.nodes[i];
    for (int child = 0; child < node.count; ++child) {
      NearestFirst::Entry below{node.children[child], 0, number};
      PieceNormals normals;
      if (WideTree::isLeaf(below.place)) {
        normals = leaves[WideTree::leaf(below.place)];
      } else {
        const WideTree::Node& under =
            tree_.part(below).nodes[static_cast<std::size_t>(below.place)];
        normals = of(place(below, 0));
        for (int j = 1; j < under.count; ++j) {
          normals = PieceNormals::around(normals, of(place(below, j)));
        }
      }
      set(place({static_cast<std::int32_t>(i), 0, number}, child), normals);
    }
  }
}

bool NormalCones::cannotFace(NearestFirst::Entry at, int child, const Vector3& point,
                             const Vector3& direction, double angle) const {
  const WideTree::Node& node = tree_.part(at).nodes[static_cast<std::size_t>(at.place)];
  Vector3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = node.bounds[axis][0][child];
    high[axis] = node.bounds[axis][1][child];
  }
  return of(place(at, child))
      .cannotFace(direction, angle, (low + high) / 2 - point,
                  (high - low).norm() / 2 + kLeastRadius);
}

PieceNormals NormalCones::of(std::size_t place) const {
  const Normals& kept = children_[place];
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

void NormalCones::set(std::size_t place, const PieceNormals& piece) {
  Normals& kept = children_[place];
  kept.cone = piece.normals;
  kept.border = piece.border == PieceNormals::Border::none ? kNoBorder : kUnknownBorder;
  if (piece.border == PieceNormals::Border::smooth) {
    kept.border = static_cast<std::int32_t>(along_borders_.size());
    along_borders_.push_back(piece.along_border);
  }
}

}  // namespace limitsurf
