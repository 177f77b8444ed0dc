// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared_surface.h"

namespace limitsurf::python {

void bindBake(py::class_<SharedSurface>& type);
void bindShadingFrames(py::module_& module);

}  // namespace limitsurf::python
