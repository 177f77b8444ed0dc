// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "support/truth/local_mesh.h"

namespace limitsurf::test {

/// The 4x4 control points around a regular face, [v][u], the missing ones beyond open sides
/// extrapolated.
using SplineGrid = std::array<std::array<Point, 4>, 4>;

SplineGrid gridAround(const LocalMesh& mesh);

/// The bicubic B-spline patch, or its derivative of the given orders.
Point evaluate(const SplineGrid& grid, const Real& u, const Real& v, int du, int dv);

}  // namespace limitsurf::test
