// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/search/polylines.h"
#include "numbers.h"

namespace limitsurf::python {

/// Curves from an array (m, 3) of points and one (k + 1,) of offsets; None for the latter makes all
/// points one curve. The names are those of the arguments. Raises ValueError for other shapes.
Polylines polylinesOf(const pybind11::object& points, const char* points_name,
                      const pybind11::object& offsets, const char* offsets_name);

}  // namespace limitsurf::python
