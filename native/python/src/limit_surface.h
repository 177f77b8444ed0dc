// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

void bindLimitSurface(pybind11::module_& module);

}  // namespace limitsurf::python
