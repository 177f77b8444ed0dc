// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limitsurf {

/// Between which distances, and how near, a ray has to come to a patch.
struct RayLimits {
  double from, to;   ///< distances along the ray
  double margin;     ///< parts of the patch that are farther aside are missed
  double tolerance;  ///< a part that nowhere is farther aside lies within the ray
};

/// What the control points of a part of a patch prove about the points at which a ray meets it.
enum class RayMeeting {
  none,          ///< There are none within the limits.
  everywhere,    ///< All of the part is within the tolerance.
  once_at_most,  ///< The ray sees no two points of the part at the same place.
  unknown,
};

/// The offset of a point of a patch from a ray, across the ray, with its derivatives by the patch's
/// parameters s and t.
struct OffsetFromRay {
  double x, y, xs, ys, xt, yt;

  double squared() const { return x * x + y * y; }
};

/// How far along a ray a point of a patch lies, with the derivatives.
struct PlaceAlongRay {
  double z, zs, zt;
};

/// The inner loops of searches along rays, compiled for the instruction set that is in use
/// (instruction_sets.h). All sets give the same bits. Bicubic polynomials are given by their
/// Bernstein coefficients, [4 t + s].
struct RayKernels {
  /// The coordinates of a patch's control points along three axes: their scalar products with each,
  /// plus `offset`. The fourth numbers are padding.
  void (*see)(const double points[16][4], const double axes[3][4], const double offset[3],
              double x[16], double y[16], double z[16]);
  /// A part of a patch with the coordinates x and y across the ray and z along it.
  RayMeeting (*meet)(const double x[16], const double y[16], const double z[16],
                     const RayLimits& limits);
  void (*offset)(const double x[16], const double y[16], double s, double t, OffsetFromRay& out);
  void (*place)(const double z[16], double s, double t, PlaceAlongRay& out);

  static const RayKernels& get();
};

}  // namespace limitsurf
