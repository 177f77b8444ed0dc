// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "numbers.h"

namespace limitsurf::python {

namespace py = pybind11;

/// A new array for results, without values. The memory of large arrays is taken from those that
/// have been freed before, of which up to kMostKept bytes are kept: memory that comes from the
/// system page by page takes several times as long as the evaluation of what is written to it.
py::array newArray(const py::dtype& dtype, std::vector<py::ssize_t> shape);

template <typename T>
py::array_t<T> newArray(std::vector<py::ssize_t> shape) {
  return newArray(py::dtype::of<T>(), std::move(shape));
}

/// Smaller arrays are numpy's: its allocator hardly ever returns their memory to the system.
constexpr std::size_t kLeastKept = std::size_t{1} << 17;
/// The memory that is kept in all.
constexpr std::size_t kMostKept = std::size_t{1} << 26;

}  // namespace limitsurf::python
