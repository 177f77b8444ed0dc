// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "limitsurf/types.h"

namespace limitsurf {

/// Two perpendicular unit vectors, the columns, that span a plane.
using PlaneBasis = Eigen::Matrix<double, 3, 2>;

/// A basis of the plane perpendicular to a unit vector (Duff et al.: "Building an orthonormal
/// basis, revisited", 2017).
PlaneBasis planeBasis(const Vector3& normal);

/// The vectors of `basis`, which is perpendicular to `from`, after the smallest rotation that turns
/// its plane into the one perpendicular to `to`. Neither normal's sign makes a difference.
PlaneBasis turned(const PlaneBasis& basis, const Vector3& from, const Vector3& to);

}  // namespace limitsurf
