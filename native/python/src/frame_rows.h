// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

namespace limitsurf::python {

/// quaternions(), frames_in_world(), leaning(), straight_strands()
void bindFrameRows(pybind11::module_& module);

}  // namespace limitsurf::python
