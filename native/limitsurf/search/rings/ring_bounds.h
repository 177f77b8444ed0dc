// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "limitsurf/surface/patches/surface_patches.h"

namespace limitsurf {

/// More than the rounding of a difference of squared distances: of places up to `reach` from a
/// vertex, and of the vertex, from a point that is `away` from the vertex. At a point of a flat
/// surface nothing else is left of the difference.
inline double differenceRounding(double reach, double away) {
  return 1e-14 * reach * (reach + 2 * away);
}

/// Bounds of the part of the surface that lies around an extraordinary vertex, between the cores of
/// one level and those of the next.
///
/// They hold in a frame whose origin is the vertex. Let rho be the distance of a point from the
/// frame's last axis, and z its height along that axis. Boxes contain the vertex or a piece of the
/// axis, however many levels there are; these bounds tell that every place is farther away than the
/// vertex, or that a ray through the vertex meets no other place.
struct RingBounds {
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  float nearest = kNone, farthest = 0;  ///< bounds of rho
  float rise = -kNone;                  ///< z <= rise rho^2
  float fall = -kNone;                  ///< -z <= fall rho^2
  float slope = 0;                      ///< |z| <= slope rho

  /// Widens the bounds by a patch.
  void include(const BezierPatch& patch, const Vector3& vertex, const Eigen::Matrix3d& frame);

  /// A lower bound of the squared distance of the surface from a point, less that of the vertex
  /// from it. `height` is the point's z, `aside` its rho.
  ///
  /// For a point p of the surface |p - q|^2 = |q|^2 + rho^2 + z^2 - 2 z height - 2 (p . q along the
  /// plane), of which the last product is at most rho aside.
  double squaredDistanceLess(double height, double aside) const;

  /// A lower bound of the distance of the surface from a line through the vertex whose angle with
  /// the plane of the frame's first two axes is `angle`.
  double distanceFromLine(double angle) const;
};

}  // namespace limitsurf
