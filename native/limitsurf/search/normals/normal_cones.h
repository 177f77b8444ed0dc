// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/normals/piece_normals.h"
#include "limitsurf/search/tree/search_tree.h"

namespace limitsurf {

/// What is known of the normals of each subtree of a search tree. It costs far more than the tree,
/// because cores are split, and is made when a search first needs it.
class NormalCones {
 public:
  NormalCones(const SearchTree& tree, int threads);

  /// Whether no place of a child, 0 to 3, of a node of the tree has both: a normal within `angle`
  /// of `direction`, a unit vector, and the smallest distance from `point` in its neighbourhood.
  /// The point is in the coordinates of boxes.
  bool cannotFace(NearestFirst::Entry node, int child, const Vector3& point,
                  const Vector3& direction, double angle) const;

 private:
  /// A PieceNormals whose cone along the border, which few have, is elsewhere.
  struct Normals {
    DirectionCone cone;
    std::int32_t border;  ///< its place in along_borders_, or one of these
  };
  static constexpr std::int32_t kNoBorder = -1, kUnknownBorder = -2;

  /// Where the cone of a node's child is.
  std::size_t place(const NearestFirst::Entry& node, int child) const {
    return WideTree::kWidth * (first_[static_cast<std::size_t>(node.part - SearchTree::kTop)] +
                               static_cast<std::size_t>(node.place)) +
           static_cast<std::size_t>(child);
  }
  /// Sets those of a part, the top or a nest, from those of its leaves. Nests come before the top.
  void setPart(std::int32_t number, const PieceNormals leaves[]);
  PieceNormals of(std::size_t place) const;
  void set(std::size_t place, const PieceNormals& piece);

  const SearchTree& tree_;
  std::vector<std::size_t> first_;  ///< for the top and each nest, the number of its first node
  std::vector<Normals> children_;
  std::vector<DirectionCone> along_borders_;
};

}  // namespace limitsurf
