// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <cstring>

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

Integers integers(const py::handle& object, const char* name) {
  const py::array array = viewed(object, name);
  const char kind = array.dtype().kind();
  const bool empty_list = array.size() == 0 && kind == 'f';  // numpy's type for []
  if (kind == 'O') {
    // Integers beyond 64 bits: no index is that large, so let them be as wrong as they are.
    py::array clipped = viewed(
        py::module_::import("numpy").attr("clip")(array, py::int_(-1), py::int_(INT64_MAX)), name);
    return py::cast<Integers>(clipped.attr("astype")("int64"));
  }
  if (kind != 'i' && kind != 'u' && !empty_list) {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected integers");
  }
  if (kind == 'u' && array.itemsize() == 8) {
    const py::object largest = py::module_::import("numpy").attr("minimum")(
        array, py::module_::import("numpy").attr("uint64")(INT64_MAX));
    return py::cast<Integers>(largest.attr("astype")("int64"));
  }
  return py::cast<Integers>(array.attr("astype")("int64", py::arg("copy") = false));
}

Doubles doubles(const py::handle& object, const char* name) {
  const py::array array = viewed(object, name);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u' && kind != 'b') {
    throw py::type_error(std::string(name) + " has dtype " + dtypeText(array) +
                         "; expected real numbers");
  }
  return py::cast<Doubles>(array.attr("astype")("float64", py::arg("copy") = false));
}

Points pointsOf(const Doubles& array) {
  return Eigen::Map<const Points>(array.data(), array.shape(0), 3);
}

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
  if (result.kind() != 'f' || (result.itemsize() != 8 && result.itemsize() != 4)) {
    throw py::type_error("dtype is " + py::cast<std::string>(py::str(result)) +
                         "; expected float64 or float32");
  }
  return result;
}

}  // namespace limitsurf::python
