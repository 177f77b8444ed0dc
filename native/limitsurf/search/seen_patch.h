// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/bernstein.h"
#include "limitsurf/search/oriented_box.h"
#include "limitsurf/search/parameter_square.h"
#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {

/// A ray with two axes across it, in coordinates of which the surface is near the origin.
struct RayFrame {
  explicit RayFrame(const Ray& ray);
  Vector3 origin, direction, across[2];
};

/// A bicubic patch as a ray sees it: how far aside of the ray its points lie, and how far along it.
class SeenPatch {
 public:
  SeenPatch(const BezierPatch& patch, const RayFrame& ray);

  Bernstein<3> x, y;  ///< aside, along the ray's two axes
  Bernstein<3> z;     ///< along the ray

  /// How far aside a point is, with derivatives.
  struct Aside {
    double x, y, xs, ys, xt, yt;

    double squared() const { return x * x + y * y; }
  };
  Aside aside(double s, double t) const;
  double along(double s, double t) const;

  /// Newton's iteration for the point that the ray passes, kept within the square. Whether the ray
  /// comes within the tolerance of where it ends.
  bool cross(const ParameterSquare& square, double tolerance, double& s, double& t) const;

  /// Levenberg and Marquardt's iteration for the least distance from the ray, within the square:
  /// slower, but for rays that only touch as well. Whether that is within the tolerance.
  bool approach(const ParameterSquare& square, double tolerance, double& s, double& t) const;

  /// The same on one of the square's sides: 0 and 1 are those along s, at the low and the high end
  /// of t, 2 and 3 those along t.
  bool approachSide(const ParameterSquare& square, int side, double tolerance, double& s,
                    double& t) const;
};

}  // namespace limitsurf
