// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// FilteredImage, blend_over(), box_sides() and box_weights().
void bindImages(pybind11::module_& module);

}  // namespace limitsurf::python
