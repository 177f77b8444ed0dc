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

/// Cones around the normals of each subtree of a search tree. They cost far more than the tree,
/// because cores are split down to the tolerance, and are made when a search first needs them.
class NormalCones {
 public:
  NormalCones(const SearchTree& tree, int threads);

  /// Of a node's child, 0 to 3.
  const NormalCone& ofChild(std::int32_t node, int child) const {
    return children_[place(node, child)];
  }

 private:
  static std::size_t place(std::int32_t node, int child) {
    return WideTree::kWidth * static_cast<std::size_t>(node) + static_cast<std::size_t>(child);
  }
  /// A cone around those of a node's children.
  NormalCone around(std::int32_t node, int count) const;

  std::vector<NormalCone> children_;
};

}  // namespace limitsurf
