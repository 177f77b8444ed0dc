// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// A cone of directions around an axis of unit length.
struct DirectionCone {
  /// More than the rounding of angles of cones, and of a search's own test of normals.
  static constexpr double kMargin = 1e-7;

  Vector3 axis = Vector3::UnitZ();
  double angle = 0;  ///< between the axis and the farthest direction; pi if nothing is known

  static DirectionCone everything();
  /// A cone around both.
  static DirectionCone around(const DirectionCone& a, const DirectionCone& b);
  bool isEverything() const;
  /// Whether no direction of the cone is within `angle` of `direction`, which has unit length.
  bool isBeyond(const Vector3& direction, double angle) const;
};

/// The cone of all normals of a patch, or everything where ds and dt are nearly parallel somewhere.
DirectionCone normalCone(const BezierPatch& patch);

/// The cone of the directions in which a side of a patch runs if the patch lies on its left, as
/// seen from the tip of a normal. The side is taken from the parameter `begin`, which is at most 0,
/// to 1: its cubic may go on beyond the patch.
DirectionCone sideCone(const BezierPatch& patch, unsigned side, double begin);

}  // namespace limitsurf
