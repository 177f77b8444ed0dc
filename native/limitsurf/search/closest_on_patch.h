// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "limitsurf/search/squared_distance.h"
#include "limitsurf/surface/bezier_patch.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// The closest point that a search has found so far.
struct ClosestSoFar {
  double distance = std::numeric_limits<double>::infinity();
  Location at;
  Vector3 direction = Vector3::Zero();  ///< of unit length, from the searching point to it

  /// Points that are closer by less than this are not searched for: a tenth of kSearchError.
  double tolerance = 0;

  /// A part of the surface may be left out if its squared distance is at least this.
  double enough() const {
    const double least = distance - tolerance;
    return least > 0 ? least * least : -std::numeric_limits<double>::infinity();
  }
  /// Takes the point at `where` if it is closer. `offset` leads there from the searching point.
  void offer(const Vector3& offset, const Location& where) {
    const double found = offset.norm();
    if (found < distance) {
      distance = found;
      at = where;
      direction = found > 0 ? Vector3(offset / found) : Vector3::Zero();
    }
  }
};

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
  bool accepts(const Location& at) const {
    const auto frame = surface.frames({&at, 1}, 1);
    return accepts(Vector3(frame(0, 2), frame(0, 5), frame(0, 8)));
  }
};

/// Improves `best` by the closest point of the patch or, with `facing`, by its closest foot that
/// meets the condition. The method is branch and bound on the squared distance; Newton's iteration
/// finds the minimum wherever the squared distance is convex.
void closestOnPatch(const BezierPatch& patch, const Vector3& point, const Facing* facing,
                    ClosestSoFar& best);

}  // namespace limitsurf
