// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// Makes the functions of the module, and those of its classes, name the argument that has a wrong
/// type, or else quote at most a line of the arguments: pybind11 would quote all of them, with all
/// numbers of lists. Constructors refuse an object that has been made.
void shortenErrors(const pybind11::module_& module);

}  // namespace limitsurf::python
