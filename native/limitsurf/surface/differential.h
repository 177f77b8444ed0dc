// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/surface/jet.h"
#include "limitsurf/surface/vertex_limit.h"

namespace limitsurf {

/// v over its length; NaN where that is 0 or not finite. Neither overflows nor underflows.
Vector3 unitDirection(const Vector3& v);

/// Unit vector along du x dv; NaN where that vanishes or is NaN. Neither overflows nor underflows.
Vector3 unitNormal(const Vector3& du, const Vector3& dv);

/// A right-handed rotation with columns tangent (along du), normal x tangent, normal. Where du or
/// the normal vanishes the frame is completed from dv, then from the least aligned world axis.
/// `normal` may have any length; zero asks for completion.
Eigen::Matrix3d frame(const Vector3& du, const Vector3& dv, const Vector3& normal);

/// Principal curvatures k1 >= k2 and unit directions, direction1 x direction2 the normal.
struct PrincipalCurvatures {
  double k1, k2;
  Vector3 direction1, direction2;
};

/// NaN where du x dv vanishes or is NaN.
PrincipalCurvatures principalCurvatures(const Jet& jet);

/// How the surface bends along two perpendicular unit vectors x and y of its tangent plane.
struct ShapeOperator {
  double xx, xy, yy;
};
PrincipalCurvatures principalCurvatures(const ShapeOperator& shape, const Vector3& x,
                                        const Vector3& y);

}  // namespace limitsurf
