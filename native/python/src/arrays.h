// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "limitsurf/types.h"

namespace limitsurf::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style>;
using Integers = py::array_t<std::int64_t, py::array::c_style>;

/// "(4, 2)".
std::string shapeText(const py::array& array);

/// Anything numpy can view as integers; TypeError for floats, booleans and the rest.
Integers integers(const py::handle& object, const char* name);

/// Anything numpy can convert to float64; TypeError for what is not real numbers.
Doubles doubles(const py::handle& object, const char* name);

/// One dimension, else Error quoting the shape.
template <typename Error>
void requireVector(const py::array& array, const char* name) {
  if (array.ndim() != 1) {
    throw Error(std::string(name) + " has shape " + shapeText(array) + "; expected (n,)");
  }
}

/// Two dimensions and `columns` columns, else Error quoting the shape.
template <typename Error>
void requireRows(const py::array& array, const char* name, int columns) {
  if (array.ndim() != 2 || array.shape(1) != columns) {
    throw Error(std::string(name) + " has shape " + shapeText(array) + "; expected (n, " +
                std::to_string(columns) + ")");
  }
}

/// A (n, 3) array as points.
Points pointsOf(const Doubles& array);

/// A float64 or float32 array of the given shape, by numpy dtype.
class Output {
 public:
  Output() = default;
  Output(const py::dtype& dtype, std::vector<py::ssize_t> shape);

  /// Copies `count` numbers to the place of the array that begins `offset` numbers in.
  void put(std::size_t offset, const double* from, std::size_t count);
  py::object object() const { return array_ ? py::object(*array_) : py::none(); }
  bool wanted() const { return array_.has_value(); }

 private:
  std::optional<py::array> array_;
  void* data_ = nullptr;
  bool single_ = false;
};

/// float64 or float32; TypeError for another.
py::dtype floatType(const py::object& dtype);

}  // namespace limitsurf::python
