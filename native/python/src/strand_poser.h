// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "numbers.h"
#include "shared_surface.h"

namespace limitsurf::python {

/// The first points of strands, from an argument `offsets`; empty for None.
std::vector<std::int64_t> strandOffsets(const py::object& offsets);
/// The class StrandPoser.
void bindStrandPoser(py::module_& module);
/// LimitSurface.strand_poser()
void bindStrandPoserMaker(SurfaceClass& type);

}  // namespace limitsurf::python
