// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "numbers.h"

namespace limitsurf::python {

namespace py = pybind11;

/// A new array for results, without values. If it is large, it uses the memory of arrays that have
/// been freed before (kept_memory.h). It is like any other array of numpy otherwise: it owns its
/// memory, and can be resized.
py::array newArray(const py::dtype& dtype, std::vector<py::ssize_t> shape);

template <typename T>
py::array_t<T> newArray(std::vector<py::ssize_t> shape) {
  return newArray(py::dtype::of<T>(), std::move(shape));
}

}  // namespace limitsurf::python
