// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// PtexLayout, and bilinear(), which reads its images.
void bindPtexLayout(pybind11::module_& module);

}  // namespace limitsurf::python
