// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limitsurf/search/search_tree.h"

namespace limitsurf {

/// A cone of directions around an axis of unit length.
struct NormalCone {
  Vector3 axis = Vector3::UnitZ();
  double angle = 0;  ///< between the axis and the farthest direction; pi if nothing is known

  static NormalCone everything();
  /// A cone around both.
  static NormalCone around(const NormalCone& a, const NormalCone& b);
  /// Whether no direction of the cone is within `angle` of `direction`, which has unit length.
  bool isBeyond(const Vector3& direction, double angle) const;
};

/// The cone of all normals of a patch, or everything where ds and dt are nearly parallel somewhere.
NormalCone normalCone(const BezierPatch& patch);

/// What is known of the normals of each subtree of a search tree. It costs far more than the tree,
/// because cores are split down to the tolerance, and is made when a search first needs it.
class NormalCones {
 public:
  NormalCones(const SearchTree& tree, int threads);

  /// Whether no place of a node's child, 0 to 3, has both: a normal within `angle` of `direction`,
  /// a unit vector, and the smallest distance from `point` in its neighbourhood. The point is in
  /// the coordinates of boxes.
  bool cannotFace(std::int32_t node, int child, const Vector3& point, const Vector3& direction,
                  double angle) const;

 private:
  struct Normals {
    NormalCone cone;
    /// Whether the surface has a normal everywhere and ends nowhere, so that the way from a point
    /// to a place with the smallest distance in its neighbourhood is along the normal there.
    bool is_smooth = false;
  };

  static std::size_t place(std::int32_t node, int child) {
    return WideTree::kWidth * static_cast<std::size_t>(node) + static_cast<std::size_t>(child);
  }
  static Normals ofLeaf(const SearchTree& tree, const SurfacePiece& leaf);
  /// Those of a node's children together.
  Normals together(std::int32_t node, int count) const;

  const WideTree& tree_;
  std::vector<Normals> children_;
};

}  // namespace limitsurf
