// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// The functions resample_strands and child_strands.
void bindChildStrands(pybind11::module_& module);

}  // namespace limitsurf::python
