// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/normals/piece_normals.h"
#include "limitsurf/search/search_tree.h"

namespace limitsurf {

/// What is known of the normals of each subtree of a search tree. It costs far more than the tree,
/// because cores are split, and is made when a search first needs it.
class NormalCones {
 public:
  NormalCones(const SearchTree& tree, int threads);

  /// Whether no place of a node's child, 0 to 3, has both: a normal within `angle` of `direction`,
  /// a unit vector, and the smallest distance from `point` in its neighbourhood. The point is in
  /// the coordinates of boxes.
  bool cannotFace(std::int32_t node, int child, const Vector3& point, const Vector3& direction,
                  double angle) const;

 private:
  /// A PieceNormals whose cone along the border, which few have, is elsewhere.
  struct Normals {
    DirectionCone cone;
    std::int32_t border;  ///< its place in along_borders_, or one of these
  };
  static constexpr std::int32_t kNoBorder = -1, kUnknownBorder = -2;

  static std::size_t place(std::int32_t node, int child) {
    return WideTree::kWidth * static_cast<std::size_t>(node) + static_cast<std::size_t>(child);
  }
  PieceNormals of(std::int32_t node, int child) const;
  void set(std::int32_t node, int child, const PieceNormals& piece);

  const WideTree& tree_;
  std::vector<Normals> children_;
  std::vector<DirectionCone> along_borders_;
};

}  // namespace limitsurf
