// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared_surface.h"

namespace limitsurf::python {

/// SubdividedFaces.
void bindSubdividedFaces(py::module_& module);

/// vector_displacement(), scalar_displacement() and displaced()
void bindDisplacement(SurfaceClass& type);

}  // namespace limitsurf::python
