// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace limitsurf::python {

/// PtexLayout, and the function that reads its images back.
void bindPtexLayout(pybind11::module_& module);

}  // namespace limitsurf::python
