// SPDX-License-Identifier: Apache-2.0
#include "short_errors.h"

#include <string>

namespace limitsurf::python {
namespace {

namespace py = pybind11;

/// The function of pybind11 that calls all others: it is the same for all of them.
PyCFunction dispatcher = nullptr;

/// Makes a TypeError name the argument of a wrong type, if pybind11 has made it, or shortens it.
PyObject* shortError(py::error_already_set& error, const py::tuple& positional,
                     const py::dict& named) {
  constexpr py::ssize_t kMost = 200;
  const py::object text = py::str(error.value());
  try {
    const py::object explanation = py::module_::import("limitsurf._argument_errors")
                                       .attr("explanation")(text, positional, named);
    if (!explanation.is_none()) {
      PyErr_SetObject(PyExc_TypeError, explanation.ptr());
      return nullptr;
    }
  } catch (py::error_already_set&) {
    // An argument whose methods raise cannot be explained.
  }
  const py::str quoting("\nInvoked with: ");
  const auto at = py::cast<py::ssize_t>(text.attr("find")(quoting));
  const py::ssize_t most = at + static_cast<py::ssize_t>(py::len(quoting)) + kMost;
  if (at < 0 || static_cast<py::ssize_t>(py::len(text)) <= most) {
    error.restore();
    return nullptr;
  }
  const py::object cut = text[py::slice(0, most, 1)];
  PyErr_SetObject(PyExc_TypeError, cut.attr("__add__")("...").ptr());
  return nullptr;
}

/// Whether an earlier call has made the object: pybind11 would ignore another one of a constructor.
bool isMade(PyObject* object) {
  py::detail::internals& pybind = py::detail::get_internals();
  auto* const type = reinterpret_cast<PyObject*>(Py_TYPE(object));
  return PyObject_TypeCheck(type, pybind.default_metaclass) != 0 &&
         reinterpret_cast<py::detail::instance*>(object)
             ->get_value_and_holder()
             .instance_registered();
}

/// Sets the error of a constructor that is called for an object that has been made.
PyObject* refuseMade(PyObject* object) {
  const py::object name = py::type::of(object).attr("__name__");
  PyErr_Format(PyExc_TypeError, "this %U has been made already: make another one", name.ptr());
  return nullptr;
}

template <bool makes>
PyObject* shortWithTuple(PyObject* self, PyObject* arguments, PyObject* named) {
  if (makes && PyTuple_GET_SIZE(arguments) > 0 && isMade(PyTuple_GET_ITEM(arguments, 0))) {
    return refuseMade(PyTuple_GET_ITEM(arguments, 0));
  }
  const auto call =
      reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(dispatcher));
  PyObject* const result = call(self, arguments, named);
  if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) {
    return result;
  }
  py::error_already_set error;
  return shortError(error, py::reinterpret_borrow<py::tuple>(arguments),
                    named == nullptr ? py::dict() : py::reinterpret_borrow<py::dict>(named));
}

/// pybind11's dispatcher, which takes an unsigned count where CPython passes a signed one.
using FastFunction = PyObject* (*)(PyObject*, PyObject* const*, std::size_t, PyObject*);

template <bool makes>
PyObject* shortWithArray(PyObject* self, PyObject* const* arguments, Py_ssize_t count,
                         PyObject* names) {
  const py::ssize_t places = PyVectorcall_NARGS(static_cast<std::size_t>(count));
  if (makes && places > 0 && isMade(arguments[0])) {
    return refuseMade(arguments[0]);
  }
  const auto call = reinterpret_cast<FastFunction>(reinterpret_cast<void (*)()>(dispatcher));
  PyObject* const result = call(self, arguments, static_cast<std::size_t>(count), names);
  if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) {
    return result;
  }
  py::error_already_set error;
  py::list positional;
  for (py::ssize_t i = 0; i < places; ++i) {
    positional.append(py::handle(arguments[i]));
  }
  py::dict named;
  for (py::ssize_t i = 0; names != nullptr && i < PyTuple_GET_SIZE(names); ++i) {
    named[PyTuple_GET_ITEM(names, i)] = py::handle(arguments[places + i]);
  }
  return shortError(error, py::tuple(positional), named);
}

template <bool makes>
PyCFunction shortCall(bool takes_array) {
  return reinterpret_cast<PyCFunction>(takes_array
                                           ? reinterpret_cast<void (*)()>(&shortWithArray<makes>)
                                           : reinterpret_cast<void (*)()>(&shortWithTuple<makes>));
}

/// `makes`: whether it is a constructor.
void shorten(py::handle function, bool makes) {
  if (PyInstanceMethod_Check(function.ptr())) {
    function = PyInstanceMethod_GET_FUNCTION(function.ptr());
  } else if (Py_TYPE(function.ptr()) == &PyStaticMethod_Type) {
    const py::object inner = function.attr("__func__");  // which the static method keeps
    shorten(inner, makes);
    return;
  }
  if (!PyCFunction_Check(function.ptr())) {
    return;
  }
  PyMethodDef& definition = *reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
  const bool takes_array = (definition.ml_flags & METH_FASTCALL) != 0;
  const PyCFunction ours = makes ? shortCall<true>(takes_array) : shortCall<false>(takes_array);
  if (definition.ml_meth == ours) {
    return;
  }
  if (dispatcher == nullptr) {
    dispatcher = definition.ml_meth;
  }
  if (definition.ml_meth == dispatcher) {
    definition.ml_meth = ours;
  }
}

}  // namespace

void shortenErrors(const py::module_& module) {
  const py::dict members = module.attr("__dict__");
  for (const auto& [name, member] : members) {
    shorten(member, false);
    if (PyType_Check(member.ptr())) {
      for (const py::handle key : py::list(member.attr("__dict__"))) {
        const auto method = py::cast<std::string>(key);
        shorten(member.attr("__dict__")[key], method == "__init__" || method == "__setstate__");
      }
    }
  }
}

}  // namespace limitsurf::python
