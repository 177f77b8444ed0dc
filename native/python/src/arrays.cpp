// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <algorithm>
#include <cstring>

#include "limitsurf/error.h"

namespace limitsurf::python {
namespace {

py::array viewed(const py::handle& object, const char* name) {
  py::array array = py::array::ensure(py::module_::import("numpy").attr("asarray")(object));
  if (!array) {
    PyErr_Clear();
    throw py::type_error(std::string(name) + " is no array");
  }
  return array;
}

std::string dtypeText(const py::array& array) {
  return py::cast<std::string>(py::str(array.dtype()));
}

}  // namespace

std::string shapeText(const py::array& array) {
  return py::cast<std::string>(py::str(py::tuple(array.attr("shape"))));
}

Integers integers(const py::handle& object, const char* name, RaiseText raise) {
  const py::array array = viewed(object, name);
  const char kind = array.dtype().kind();
  const auto beyond = [&](const py::handle& value, std::int64_t place) {
    raise(std::string(name) + " has the value " + py::cast<std::string>(py::str(value)) +
          " at place " + std::to_string(place) + ", which no index can have");
  };
  if (kind == 'O') {  // Python's own integers, which may be of any size
    Integers result(std::vector<py::ssize_t>(array.shape(), array.shape() + array.ndim()));
    std::int64_t* to = result.mutable_data();
    for (const py::handle value : array.attr("ravel")().attr("tolist")()) {
      if (!PyLong_Check(value.ptr()) || PyBool_Check(value.ptr())) {
        throw py::type_error(std::string(name) + " has the value " +
                             py::cast<std::string>(py::repr(value)) + "; expected integers");
      }
      int overflow = 0;
      *to++ = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
      if (overflow != 0) {
        beyond(value, to - 1 - result.data());
      }
    }
    return result;
  }
  const bool empty_list = array.size() == 0 && kind == 'f';  // numpy's type for []
  if (kind != 'i' && kind != 'u' && !empty_list) {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected integers");
  }
  if (kind == 'u' && array.itemsize() == 8 && array.size() > 0) {
    const py::object largest = array.attr("max")();
    if (py::cast<std::uint64_t>(largest) > static_cast<std::uint64_t>(INT64_MAX)) {
      beyond(largest, py::cast<std::int64_t>(array.attr("argmax")()));
    }
  }
  return py::cast<Integers>(array.attr("astype")("int64", py::arg("copy") = false));
}

Doubles doubles(const py::handle& object, const char* name) {
  const py::array array = viewed(object, name);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b' && kind != 'O') {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected real numbers");
  }
  return py::cast<Doubles>(array.attr("astype")("float64", py::arg("copy") = false));
}

Floats floats(const py::object& object, const char* name) {
  const py::array array = viewed(object, name);
  const bool is_small = array.dtype().kind() == 'f' && array.dtype().itemsize() <= 4;
  return py::cast<Floats>((is_small ? array : py::array(doubles(array, name)))
                              .attr("astype")("float32", py::arg("copy") = false));
}

Points rowsOfThree(const py::handle& object, const char* name) {
  Doubles array = doubles(object, name);
  if (array.ndim() == 1 && array.size() == 0) {
    array = Doubles(std::vector<py::ssize_t>{0, 3});
  }
  requireRows<std::invalid_argument>(array, name, 3);
  return pointsOf(array);
}

std::vector<std::pair<std::int64_t, std::int64_t>> pairsOf(const py::handle& object,
                                                           const char* name) {
  const Integers array = integers<MeshError>(object, name);
  if (array.ndim() == 1 && array.size() == 0) {
    return {};
  }
  requireRows<MeshError>(array, name, 2);
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  pairs.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t row = 0; row < array.shape(0); ++row) {
    pairs.emplace_back(array.at(row, 0), array.at(row, 1));
  }
  return pairs;
}

Points pointsOf(const Doubles& array) {
  Points points(array.shape(0), 3);
  const double* const from = array.data();
  forEachRow(static_cast<std::size_t>(array.shape(0)),
             [&](std::size_t row) { std::copy_n(from + 3 * row, 3, points.data() + 3 * row); });
  return points;
}

py::array_t<double> pointArray(Points points) { return rowArray(std::move(points)); }

Output::Output(const py::dtype& dtype, std::vector<py::ssize_t> shape)
    : array_(py::array(dtype, std::move(shape))),
      data_(array_->mutable_data()),
      single_(dtype.itemsize() == 4) {}

void Output::put(std::size_t offset, const double* from, std::size_t count) {
  if (single_) {
    float* to = static_cast<float*>(data_) + offset;
    for (std::size_t i = 0; i < count; ++i) {
      to[i] = static_cast<float>(from[i]);
    }
  } else if (count > 0) {
    std::memcpy(static_cast<double*>(data_) + offset, from, count * sizeof(double));
  }
}

py::dtype floatType(const py::object& dtype) {
  const py::dtype result = py::dtype::from_args(dtype);
  if (result.kind() != 'f' || (result.itemsize() != 8 && result.itemsize() != 4) ||
      !py::cast<bool>(result.attr("isnative"))) {
    throw py::type_error("dtype is " + py::cast<std::string>(py::str(result)) +
                         "; expected float64 or float32 in the machine's byte order");
  }
  return result;
}

}  // namespace limitsurf::python
