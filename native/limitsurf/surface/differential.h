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

/// Principal curvatures k1 >= k2 and unit directions; NaN where du x dv vanishes or is NaN.
struct PrincipalCurvatures {
  double k1, k2;
  Vector3 direction1, direction2;
};
PrincipalCurvatures principalCurvatures(const Jet& jet);

}  // namespace limitsurf
