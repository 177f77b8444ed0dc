// SPDX-License-Identifier: Apache-2.0
#include "polylines.h"

#include <stdexcept>
#include <string>

#include "batches.h"

namespace limitsurf::python {

Polylines polylinesOf(const py::object& points, const char* points_name, const py::object& offsets,
                      const char* offsets_name) {
  Polylines curves{rowsOfThree(points, points_name), {}};
  curves.offsets = {0, curves.points.rows()};
  if (!offsets.is_none()) {
    const Integers given = integers<std::invalid_argument>(offsets, offsets_name);
    requireVector<std::invalid_argument>(given, offsets_name);
    curves.offsets.assign(given.data(), given.data() + given.size());
  }
  return curves;
}

}  // namespace limitsurf::python
