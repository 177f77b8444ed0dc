// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// quaternions(), frames_in_world(), leaning(), straight_strands()
void bindFrameRows(pybind11::module_& module);

}  // namespace limitsurf::python
