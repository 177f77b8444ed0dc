// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "limitsurf/search/rays/patch_in_ray_frame.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A point at which a ray meets the surface.
struct RayHit {
  double distance;
  Location at;
  /// Not set where only the first hit is wanted, which is compared with no other.
  Vector3 position{};
  /// The sine of the angle between the ray and the surface; 0 where the surface's tangents are
  /// parallel. Not set where only the first hit is wanted.
  double sine = 0;

  /// How far along the ray the surface stays within twice the tolerance of it: another hit so near
  /// may be the same.
  double slack(double tolerance) const { return slack(sine, tolerance); }
  static double slack(double sine, double tolerance) {
    return 2 * tolerance / std::max(sine, kGrazingSine);
  }
  /// At smaller angles the curvature of the surface, not the angle, leads it away from the ray.
  static constexpr double kGrazingSine = 1e-7;
};

/// Collects the hits of one ray.
struct CollectedHits {
  bool first_only;  ///< only the nearest hit is wanted
  /// The distance at which the ray begins.
  double from;
  /// Hits farther away are not searched for: the largest distance or, with first_only, that of the
  /// nearest hit so far.
  double nearest;
  /// By how much rounding may have moved the ray aside, which grows with the distance of its
  /// origin.
  double rounding = 0;
  /// The distance from the surface within which the ray counts as meeting it: a tenth of
  /// kSearchError, and the rounding.
  double tolerance;
  /// Parts of the surface farther from the ray than this are not searched. It is more than rounding
  /// and less than the tolerance: points between the two are hits if the search comes upon them.
  double margin() const { return (tolerance - rounding) / 32 + rounding; }
  std::vector<RayHit> hits;
  std::int64_t cells = 0;  ///< the number of parts of patches that were looked at

  void add(const RayHit& hit);
};

/// Adds the points at which the ray meets the patch. The method is exact subdivision of the patch
/// as seen along the ray, preconditioned so that the patch's parameters are nearly its coordinates.
/// Newton's iteration finds the point wherever at most one root is possible; where the ray only
/// touches the patch, the point nearest to the ray is taken.
void intersectPatch(const BezierPatch& patch, const RayFrame& ray, CollectedHits& out);

}  // namespace limitsurf
