// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "limitsurf/search/seen_patch.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A place where a ray meets the surface.
struct RayHit {
  double distance;
  Location at;
  Vector3 position;
  /// Of the angle between the ray and the surface; 0 where its tangents are parallel.
  double sine;

  /// How far along the ray the surface is within twice the tolerance of it: other hits so near may
  /// be the same. At angles below 1e-7 it is the surface's curvature that leads away.
  double slack(double tolerance) const { return 2 * tolerance / std::max(sine, 1e-7); }
};

/// Collects what one ray meets.
struct CollectedHits {
  bool first_only;
  /// Where the ray begins.
  double from;
  /// Hits farther away are not looked for; with first_only the nearest so far.
  double nearest;
  /// How near the ray has to be to the surface, a tenth of kSearchError.
  double tolerance;
  /// How near it may come without being followed up: more than rounding. What lies between the two
  /// is a hit if it is come upon.
  double margin() const { return tolerance / 32; }
  std::vector<RayHit> hits;

  void add(const RayHit& hit);
};

/// The places where the ray meets the patch: exact subdivision of the patch as seen along the ray,
/// preconditioned so that its parameters are nearly the coordinates, ended by Newton's iteration
/// wherever at most one root is possible; where the ray only touches the patch, by the point that
/// is nearest to it.
void rayOnPatch(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out);

}  // namespace limitsurf
