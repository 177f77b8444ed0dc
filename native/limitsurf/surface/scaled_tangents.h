// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/own_unit.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// du and dv in units of their own, so that products of several lengths neither overflow nor
/// underflow. The units are powers of two: all digits stay.
struct ScaledTangents {
  ScaledTangents(const Vector3& with_u, const Vector3& with_v)
      : u_scale(scaleToOwnUnit(with_u.cwiseAbs().maxCoeff())),
        v_scale(scaleToOwnUnit(with_v.cwiseAbs().maxCoeff())),
        du(u_scale * with_u),
        dv(v_scale * with_v) {}

  double u_scale, v_scale;  ///< what they were multiplied by
  Vector3 du, dv;
};

}  // namespace limitsurf
