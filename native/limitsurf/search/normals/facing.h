// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The third axis of the surface's frame, which exists also where there is no normal.
inline Vector3 frameNormal(const LimitSurface& surface, const Location& at) {
  const auto frame = surface.frames({&at, 1}, 1);
  return {frame(0, 2), frame(0, 5), frame(0, 8)};
}

/// A condition on feet: the normal must be within an angle of a direction.
struct Facing {
  const LimitSurface& surface;
  Vector3 direction;
  double least_cosine;

  /// Where there is no normal (NaN), the condition is met only if it is none: by an angle of pi.
  bool accepts(const Vector3& normal) const {
    return least_cosine < -1 ||
           normal.dot(direction) >= least_cosine * normal.norm() * direction.norm();
  }
  /// The same test with the normal that evaluate() gives.
  bool accepts(const Location& at) const {
    return accepts(
        surface.evaluate({&at, 1}, Derivatives::first, true, 1).normal.row(0).transpose());
  }
  /// The same at (s, t) of a patch, whose derivatives there are `ds` and `dt`. On patches so small
  /// that a Location cannot tell their places apart, the location decides that stands for the
  /// place.
  bool accepts(const BezierPatch& patch, double s, double t, const Vector3& ds,
               const Vector3& dt) const;

  /// Whether no normal of the patch meets the condition for certain.
  bool excludes(const BezierPatch& patch) const;
  /// Whether none does because the patch is collapsed onto a line, and has no normals.
  bool excludesLine(const BezierPatch& patch) const;
};

}  // namespace limitsurf
