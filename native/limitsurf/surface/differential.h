// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/surface/batch/normal_limits.h"
#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/limit_surface.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// v over its length; NaN where the length is 0 or not finite. The computation neither overflows
/// nor underflows.
Vector3 unitDirection(const Vector3& v);

/// The unit vector along du x dv; NaN where that vanishes or is NaN. The computation neither
/// overflows nor underflows.
Vector3 unitNormal(const Vector3& du, const Vector3& dv);

/// Whether du x dv meets the limits, and no product of lengths overflows or underflows.
bool meetsLimits(const Vector3& du, const Vector3& dv, const NormalLimits& limits);

/// Whether the squared sine of the angle between du and dv is at least this, in any unit of length.
bool areApart(const Vector3& du, const Vector3& dv, double lowest_sine_square);

/// Whether the condition number of the normal is at most kMostNormalCondition. `size` is what the
/// rounding of du and dv is relative to.
bool isWellConditioned(const Vector3& du, const Vector3& dv, double size);

/// A right-handed rotation with columns tangent (along du), normal x tangent, normal. Where du or
/// the normal vanishes the frame is completed from dv, then from the least aligned world axis.
/// `normal` may have any length; zero asks for completion.
Eigen::Matrix3d frame(const Vector3& du, const Vector3& dv, const Vector3& normal);

/// Principal curvatures k1 >= k2 and their unit directions; direction1 x direction2 is the normal.
struct PrincipalCurvatures {
  double k1, k2;
  Vector3 direction1, direction2;
};

/// What curvature is made of. Lengths and parameters are in units in which nothing overflows or
/// underflows.
struct FundamentalForms {
  Vector3 du, dv;
  Vector3 cross;      ///< du x dv; may be more accurate than the product of `du` and `dv`
  double uu, uv, vv;  ///< the second derivatives' parts along the normal (second form: L, M, N)
  double scale = 1;   ///< of curvatures that are computed from these forms, against those in space

  /// Of the angle between du and dv; 0 where either vanishes.
  double sine() const;
};

/// The second derivatives' parts along the normal are taken from the sums that they are. Deep in a
/// ring tile they are small beside the sums: TileEvaluator::fundamentalForms() keeps their digits.
FundamentalForms fundamentalForms(const Jet& jet);

/// All members are NaN where du x dv vanishes or is NaN.
PrincipalCurvatures principalCurvatures(const FundamentalForms& forms);

/// The second fundamental form on two perpendicular unit vectors x and y of the tangent plane.
struct ShapeOperator {
  double xx, xy, yy;
};
PrincipalCurvatures principalCurvatures(const ShapeOperator& shape, const Vector3& x,
                                        const Vector3& y);

}  // namespace limitsurf
