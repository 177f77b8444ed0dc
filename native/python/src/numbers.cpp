// SPDX-License-Identifier: Apache-2.0
#include "numbers.h"

namespace limitsurf::python {

namespace py = pybind11;

bool isMasked(const py::handle& object) {
  static PyObject* const masked_array =
      py::object(py::module_::import("numpy.ma").attr("MaskedArray")).release().ptr();  // for good
  return PyObject_IsInstance(object.ptr(), masked_array) == 1;
}

bool isBool(const py::handle& object) {
  static PyObject* const numpy_bool =
      py::object(py::module_::import("numpy").attr("bool_")).release().ptr();  // for good
  return PyBool_Check(object.ptr()) || PyObject_IsInstance(object.ptr(), numpy_bool) == 1;
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
  // PyNumber_Float() reads texts, too.
  if (PyNumber_Check(object.ptr()) == 0 || isBool(object) || isMasked(object)) {
    return {};
  }
  if (const auto array = py::reinterpret_borrow<py::object>(object);
      py::isinstance<py::array>(array) &&
      (py::array(array).ndim() > 0 || py::array(array).dtype().kind() == 'b')) {
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
