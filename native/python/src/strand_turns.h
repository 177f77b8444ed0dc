// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numbers.h"

namespace limitsurf::python {

/// shortest_turns(), rotation_matrices() and move_strands()
void bindStrandTurns(pybind11::module_& module);

}  // namespace limitsurf::python
