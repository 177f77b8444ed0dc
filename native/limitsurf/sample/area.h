// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limitsurf/surface/limit_surface.h"

namespace limitsurf {

/// Bound on the relative error of surfaceArea(); measured, not derived. It does not hold where du x
/// dv vanishes inside faces, as along the folds of a mesh that is folded over in a plane: the
/// integrand has kinks there. measuredArea() says how large the error is then.
constexpr double kAreaError = 1e-9;

/// An area, and what is known about it.
struct SurfaceArea {
  double value = 0;
  /// An estimate of the error, in the same unit: of the quadrature, of the extrapolation around
  /// extraordinary vertices, and of rounding. A rule can be misled, so this is no strict bound.
  double error = 0;
  /// The number of places at which du x dv was evaluated: what the cost is proportional to.
  std::int64_t evaluations = 0;
};

/// Area of the limit surface, in squared units of the control mesh, by Gauss-Legendre quadrature on
/// squares of parameters. Where the result is not exact to kAreaError, squares are quartered, those
/// with the largest errors first, until it is, or until 131,072 squares have been made (64 of each
/// tile, if there are more than 2,048 such tiles).
///
/// Any number of threads gives the same bits. Lengths are in a unit of the mesh's own size, so that
/// the relative error does not depend on the scale.
///
/// Cost: O(tiles), whatever the positions are.
SurfaceArea measuredArea(const LimitSurface& surface, int threads = 0);

/// Only the value of measuredArea().
double surfaceArea(const LimitSurface& surface, int threads = 0);

}  // namespace limitsurf
