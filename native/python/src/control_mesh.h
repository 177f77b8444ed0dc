// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "limitsurf/mesh/control_mesh.h"

namespace limitsurf::python {

void bindControlMesh(pybind11::module_& module);

}  // namespace limitsurf::python
