// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared_surface.h"

namespace limitsurf::python {

void bindBake(py::class_<SharedSurface>& type);

}  // namespace limitsurf::python
