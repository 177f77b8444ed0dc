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

  bool accepts(const Vector3& normal) const {
    return normal.dot(direction) >= least_cosine * normal.norm() * direction.norm();
  }
  /// The same test with the surface's frame, for places where the tangents do not determine the
  /// normal.
  bool accepts(const Location& at) const { return accepts(frameNormal(surface, at)); }
  /// The same at (s, t) of a patch, whose derivatives there are `ds` and `dt`.
  bool accepts(const BezierPatch& patch, double s, double t, const Vector3& ds,
               const Vector3& dt) const;

  /// Whether no normal of the patch meets the condition for certain.
  bool excludes(const BezierPatch& patch) const;
};

}  // namespace limitsurf
