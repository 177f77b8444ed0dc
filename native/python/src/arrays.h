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
using Floats = py::array_t<float, py::array::c_style>;

/// "(4, 2)".
std::string shapeText(const py::array& array);

/// Throws the error that a wrong value in an array deserves.
using RaiseText = void (*)(const std::string&);

Integers integers(const py::handle& object, const char* name, RaiseText raise);

/// Anything numpy can view as integers; TypeError for floats, booleans and the rest, Error for
/// integers beyond 64 bits.
template <typename Error>
Integers integers(const py::handle& object, const char* name) {
  return integers(object, name, [](const std::string& text) { throw Error(text); });
}

/// Anything numpy can convert to float64; TypeError for what is not real numbers.
Doubles doubles(const py::handle& object, const char* name);

/// The same rounded to float32, without a detour where that is what it is.
Floats floats(const py::object& object, const char* name);

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

template <typename T>
py::array_t<T> arrayOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
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
