// SPDX-License-Identifier: Apache-2.0
#include "numbers.h"

namespace limitsurf::python {

namespace py = pybind11;

namespace {

/// Whether an object is a real number, by its type. PyNumber_Float() would also read texts, drop
/// imaginary parts, and take the only number of an array.
bool isReal(const py::handle& object) {
  if (PyFloat_Check(object.ptr()) || PyLong_CheckExact(object.ptr())) {
    return true;
  }
  if (PyNumber_Check(object.ptr()) == 0 || isBool(object) || isMasked(object)) {
    return false;
  }
  const bool is_array = py::isinstance<py::array>(object);
  if (!is_array && !isNumpyScalar(object)) {
    return true;
  }
  if (is_array && py::reinterpret_borrow<py::array>(object).ndim() > 0) {
    return false;
  }
  const char kind = py::cast<py::dtype>(object.attr("dtype")).kind();
  if (kind == 'O') {
    const py::object inside = object.attr("item")();
    return !py::isinstance<py::array>(inside) && isReal(inside);
  }
  return kind == 'f' || kind == 'i' || kind == 'u';
}

}  // namespace

bool isMasked(const py::handle& object) {
  static PyObject* const masked_array =
      py::object(py::module_::import("numpy.ma").attr("MaskedArray")).release().ptr();  // for good
  return Py_TYPE(object.ptr()) != py::detail::npy_api::get().PyArray_Type_ &&
         PyObject_IsInstance(object.ptr(), masked_array) == 1;
}

bool isBool(const py::handle& object) {
  static PyObject* const numpy_bool =
      py::object(py::module_::import("numpy").attr("bool_")).release().ptr();  // for good
  return PyBool_Check(object.ptr()) || PyObject_IsInstance(object.ptr(), numpy_bool) == 1;
}

bool isNumpyScalar(const py::handle& object) {
  static PyObject* const scalar =
      py::object(py::module_::import("numpy").attr("generic")).release().ptr();  // for good
  return PyObject_IsInstance(object.ptr(), scalar) == 1;
}

py::object integerOf(const py::handle& object) {
  if (!object || PyLong_CheckExact(object.ptr())) {
    return py::reinterpret_borrow<py::object>(object);
  }
  if (PyFloat_CheckExact(object.ptr()) || isBool(object) || isMasked(object)) {
    return {};
  }
  py::object number = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
  if (!number) {
    py::error_already_set error;
    if (!error.matches(PyExc_TypeError)) {
      throw error;
    }
  }
  return number;
}

py::object realOf(const py::handle& object) {
  if (PyFloat_CheckExact(object.ptr())) {
    return py::reinterpret_borrow<py::object>(object);
  }
  if (!isReal(object)) {
    return {};
  }
  py::object number = py::reinterpret_steal<py::object>(PyNumber_Float(object.ptr()));
  if (!number) {
    py::error_already_set error;
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError) &&
        !error.matches(PyExc_OverflowError)) {
      throw error;
    }
  }
  return number;
}

}  // namespace limitsurf::python
