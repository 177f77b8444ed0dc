// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/bernstein.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/parameter_rectangle.h"
#include "limitsurf/search/rays/ray_kernels.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A ray and two axes perpendicular to it, in coordinates in which the surface lies near the
/// origin.
struct RayFrame {
  RayFrame() = default;
  explicit RayFrame(const Ray& ray);
  Vector3 origin, direction, across[2];
};

/// A bicubic patch in the frame of a ray: how far aside of the ray its points lie, and how far
/// along it.
class PatchInRayFrame {
 public:
  PatchInRayFrame(const BezierPatch& patch, const RayFrame& ray);

  Bernstein<3> x, y;  ///< aside, along the ray's two axes
  Bernstein<3> z;     ///< along the ray

  /// Tells at which points the ray meets a part of a patch.
  RayMeeting meet(const Bernstein<3>& part_x, const Bernstein<3>& part_y,
                  const Bernstein<3>& part_z, const RayLimits& limits) const {
    return kernels_->meet(part_x.data(), part_y.data(), part_z.data(), limits);
  }

  OffsetFromRay offset(double s, double t) const {
    OffsetFromRay result;
    kernels_->offset(x.data(), y.data(), s, t, result);
    return result;
  }
  PlaceAlongRay place(double s, double t) const {
    PlaceAlongRay result;
    kernels_->place(z.data(), s, t, result);
    return result;
  }

  /// Newton's iteration, within the rectangle, for the point at which the ray crosses the patch.
  /// Returns whether the point at which it ends is within the tolerance of the ray.
  bool cross(const ParameterRectangle& on, double tolerance, double& s, double& t) const;

  /// The Levenberg-Marquardt iteration, within the rectangle, for the least distance from the ray.
  /// It is slower, but also finds points that the ray only touches. Returns whether that distance
  /// is within the tolerance.
  bool approach(const ParameterRectangle& on, double tolerance, double& s, double& t) const;

  /// The same iteration for the least distance from the point of the ray at `distance`, not
  /// from the ray.
  bool approachPoint(const ParameterRectangle& on, double distance, double tolerance, double& s,
                     double& t) const;

  /// approach() on one side of the rectangle: sides 0 and 1 lie along s, at the low and the high
  /// end of t, sides 2 and 3 along t.
  bool approachSide(const ParameterRectangle& on, int side, double tolerance, double& s,
                    double& t) const;

 private:
  const RayKernels* kernels_;
};

}  // namespace limitsurf
