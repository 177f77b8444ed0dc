// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/surface/jet.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// v over its length; NaN where the length is 0 or not finite. The computation neither overflows
/// nor underflows.
Vector3 unitDirection(const Vector3& v);

/// The unit vector along du x dv; NaN where that vanishes or is NaN. The computation neither
/// overflows nor underflows.
Vector3 unitNormal(const Vector3& du, const Vector3& dv);

/// A right-handed rotation with columns tangent (along du), normal x tangent, normal. Where du or
/// the normal vanishes the frame is completed from dv, then from the least aligned world axis.
/// `normal` may have any length; zero asks for completion.
Eigen::Matrix3d frame(const Vector3& du, const Vector3& dv, const Vector3& normal);

/// Principal curvatures k1 >= k2 and their unit directions; direction1 x direction2 is the normal.
struct PrincipalCurvatures {
  double k1, k2;
  Vector3 direction1, direction2;
};

/// All members are NaN where du x dv vanishes or is NaN.
PrincipalCurvatures principalCurvatures(const Jet& jet);

/// The second fundamental form on two perpendicular unit vectors x and y of the tangent plane.
struct ShapeOperator {
  double xx, xy, yy;
};
PrincipalCurvatures principalCurvatures(const ShapeOperator& shape, const Vector3& x,
                                        const Vector3& y);

}  // namespace limitsurf
