// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/tree/nest_builder.h"

#include "limitsurf/search/box_tree.h"
#include "limitsurf/search/wide_tree.h"

namespace limitsurf {

NestBuilder::Leaves NestBuilder::leaves(const std::vector<SurfacePiece>& pieces) const {
  Leaves made;
  const std::size_t count = leafCount(pieces);
  made.leaves.reserve(count);
  made.patches.reserve(count);
  SurfacePatches::SplitCore split;
  const auto addPatch = [&](const SurfacePiece& piece, const BezierPatch& patch) {
    made.patches.push_back(patch);
    made.leaves.push_back(maker_.ofPatch(piece, patch));
  };
  for (const SurfacePiece& piece : pieces) {
    if (!piece.isCore()) {
      addPatch(piece, patches_.patch(piece));
      continue;
    }
    SurfacePiece rest = piece;
    for (int step = maker_.stepsBefore(piece); step > 0; --step) {
      patches_.split(rest, split);
      rest = split.core;
      for (int quarter = 0; quarter < 3; ++quarter) {
        addPatch(split.pieces[quarter], split.patches[quarter]);
      }
    }
    if (!maker_.isOfRing(piece)) {
      made.patches.emplace_back();
      made.leaves.push_back(maker_.ofCore(rest, split));
    }
  }
  return made;
}

BuiltPart NestBuilder::build(const std::vector<SurfacePiece>& pieces) const {
  const auto [leaves, patches] = this->leaves(pieces);
  std::vector<BoxF> boxes;
  boxes.reserve(leaves.size());
  for (const LeafMaker::Leaf& leaf : leaves) {
    boxes.push_back(leaf.box);
  }
  std::vector<std::int32_t> order;
  BuiltPart nest;
  nest.nodes = WideTree(BoxTree(boxes, order, 1), 1).takeNodes();
  nest.leaves.reserve(leaves.size());
  nest.patches.reserve(leaves.size());
  for (const std::int32_t leaf : order) {
    nest.leaves.push_back(leaves[static_cast<std::size_t>(leaf)].leaf);
    nest.patches.push_back(patches[static_cast<std::size_t>(leaf)]);
  }
  return nest;
}

std::size_t NestBuilder::leafCount(const std::vector<SurfacePiece>& pieces) const {
  std::size_t leaves = 0;
  for (const SurfacePiece& piece : pieces) {
    const int of_core = piece.isCore() ? 3 * maker_.stepsBefore(piece) : 0;
    leaves +=
        static_cast<std::size_t>(of_core) + (piece.isCore() && maker_.isOfRing(piece) ? 0 : 1);
  }
  return leaves;
}

}  // namespace limitsurf
