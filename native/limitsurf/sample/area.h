// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Area: relative to the area. Not where du x dv vanishes along a curve, as on a mesh folded over
/// in a plane: there the integrand has a kink and 1e-7 is reached.
constexpr double kAreaError = 1e-9;

/// Area of the limit surface; relative error: see kAreaError.
double surfaceArea(const LimitSurface& surface, int threads = 0);

}  // namespace limitsurf
