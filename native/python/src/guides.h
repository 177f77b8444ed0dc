// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace limitsurf::python {

/// The functions resample_strands and child_strands.
void bindChildStrands(pybind11::module_& module);

}  // namespace limitsurf::python
