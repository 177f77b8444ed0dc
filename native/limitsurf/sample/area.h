// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Bound on the relative error of surfaceArea(); measured, not derived. It does not hold where du x
/// dv vanishes along a curve, as on a mesh that is folded over in a plane: the integrand has a kink
/// there, and the error reaches 1e-7.
constexpr double kAreaError = 1e-9;

/// Area of the limit surface, in squared units of the control mesh, by Gauss-Legendre quadrature on
/// parameter squares that are halved until it has converged. Relative error: kAreaError.
double surfaceArea(const LimitSurface& surface, int threads = 0);

}  // namespace limitsurf
