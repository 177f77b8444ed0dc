// SPDX-License-Identifier: Apache-2.0
#include "polylines.h"

#include <stdexcept>
#include <string>

#include "batches.h"

namespace limitsurf::python {

Polylines polylinesOf(const py::object& points, const char* points_name, const py::object& offsets,
                      const char* offsets_name) {
  const Doubles array = doubles(points, points_name);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw py::value_error(std::string(points_name) + " has shape " + shapeText(array) +
                          "; expected (m, 3)");
  }
  Polylines curves{pointsOf(array), {0, array.shape(0)}};
  if (!offsets.is_none()) {
    const Integers given = integers<std::invalid_argument>(offsets, offsets_name);
    requireVector<std::invalid_argument>(given, offsets_name);
    curves.offsets.assign(given.data(), given.data() + given.size());
  }
  return curves;
}

}  // namespace limitsurf::python
