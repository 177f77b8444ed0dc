// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"
#include "shared_surface.h"

namespace limitsurf::python {

/// The class EdgeCurves.
void bindEdgeCurves(py::module_& module);
/// LimitSurface.edge_curves() and LimitSurface.scatter_along()
void bindEdgeCurveMakers(SurfaceClass& type);

}  // namespace limitsurf::python
