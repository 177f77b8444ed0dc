// SPDX-License-Identifier: Apache-2.0
#include "python_calls.h"

#include <pybind11/numpy.h>

#include <cstddef>

#include "gil.h"

namespace limitsurf::python {
namespace {

using Numpy = pybind11::detail::npy_api;

/// A function in numpy's table, which is replaced by one that waits.
template <auto member>
struct NumpyCall;

template <typename Result, typename... Arguments, Result (*Numpy::*member)(Arguments...)>
struct NumpyCall<member> {
  static inline Result (*real)(Arguments...) = nullptr;

  static Result call(Arguments... arguments) {
    Result result{};
    orWaitForTheEnd([&] { result = real(arguments...); });
    return result;
  }
  static void replace() {
    Numpy& numpy = Numpy::get();
    real = numpy.*member;
    numpy.*member = &call;
  }
};

}  // namespace

void guardNumpyCalls() {
  NumpyCall<&Numpy::PyArray_NewCopy_>::replace();
  NumpyCall<&Numpy::PyArray_FromAny_>::replace();
}

}  // namespace limitsurf::python

#if defined(LIMITSURF_WRAPS_CALLS)

using limitsurf::python::orWaitForTheEnd;

// NOLINTBEGIN(bugprone-reserved-identifier): the linker gives the names
extern "C" {

PyObject* __real_PyObject_Vectorcall(PyObject*, PyObject* const*, std::size_t, PyObject*);
PyObject* __real_PyObject_Call(PyObject*, PyObject*, PyObject*);
PyObject* __real_PyObject_CallObject(PyObject*, PyObject*);

[[gnu::used]] PyObject* __wrap_PyObject_Vectorcall(PyObject* function, PyObject* const* arguments,
                                                   std::size_t count, PyObject* names) {
  PyObject* result = nullptr;
  orWaitForTheEnd([&] { result = __real_PyObject_Vectorcall(function, arguments, count, names); });
  return result;
}

[[gnu::used]] PyObject* __wrap_PyObject_Call(PyObject* function, PyObject* arguments,
                                             PyObject* named) {
  PyObject* result = nullptr;
  orWaitForTheEnd([&] { result = __real_PyObject_Call(function, arguments, named); });
  return result;
}

[[gnu::used]] PyObject* __wrap_PyObject_CallObject(PyObject* function, PyObject* arguments) {
  PyObject* result = nullptr;
  orWaitForTheEnd([&] { result = __real_PyObject_CallObject(function, arguments); });
  return result;
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier)

#endif
