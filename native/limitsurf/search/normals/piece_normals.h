// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/normals/direction_cone.h"

namespace limitsurf {

/// What is known of the normals and the borders of a part of the surface, so that it can be left
/// out of a search for local minima of the distance.
struct PieceNormals {
  enum class Border {
    none,    ///< the surface ends nowhere
    smooth,  ///< it ends along curves whose directions, with the surface on the left, are known
    unknown  ///< it has a corner, or a place without a normal
  };

  DirectionCone normals;
  Border border = Border::none;
  DirectionCone along_border;  ///< if `border` is smooth

  /// That of two parts together.
  static PieceNormals around(const PieceNormals& a, const PieceNormals& b);

  /// Whether no place within `radius` from the middle of a sphere has both: a normal within `angle`
  /// of `direction`, a unit vector, and the smallest distance from a point in its neighbourhood.
  /// `way` leads from the point to the middle.
  bool cannotFace(const Vector3& direction, double angle, const Vector3& way, double radius) const;
};

}  // namespace limitsurf
