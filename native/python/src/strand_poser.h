// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "shared_surface.h"

namespace limitsurf::python {

/// The class StrandPoser.
void bindStrandPoser(py::module_& module);
/// LimitSurface.strand_poser()
void bindStrandPoserMaker(py::class_<SharedSurface>& type);

}  // namespace limitsurf::python
