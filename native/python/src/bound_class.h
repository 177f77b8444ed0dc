// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <typeinfo>

#include "numbers.h"
#include "value_text.h"

namespace limitsurf::python {

/// What pickle and copy make an object of: the class, and what its __getstate__() returns.
inline pybind11::tuple reduced(const pybind11::object& self) {
  const pybind11::type type = pybind11::type::of(self);
  if (!pybind11::hasattr(type, "__setstate__")) {
    throw pybind11::type_error("cannot pickle '" +
                               std::string(pybind11::str(type.attr("__name__"))) + "' object");
  }
  return pybind11::make_tuple(pybind11::module_::import("copyreg").attr("__newobj__"),
                              pybind11::make_tuple(type), self.attr("__getstate__")());
}

/// What a __setstate__() is given. Throws TypeError unless it is a tuple.
inline pybind11::tuple stateTuple(const pybind11::object& given, const char* class_name) {
  if (!pybind11::isinstance<pybind11::tuple>(given)) {
    throw pybind11::type_error(std::string("no state of a ") + class_name + ": " +
                               valueText(given) + " is no tuple");
  }
  return pybind11::reinterpret_borrow<pybind11::tuple>(given);
}

/// A new class of the module, a py::class_. Python can make an object without initialising it
/// (`cls.__new__(cls)`), for which pybind11 would allocate memory when a function first takes it:
/// such objects raise TypeError instead.
///
/// Python's own __reduce__(), and protocols 0 and 1 of pickle, would make an object of pybind11's
/// base class, which ends the process. Objects are reduced as for protocol 2 instead: those that do
/// not pickle raise TypeError.
template <typename Class>
Class boundClass(pybind11::module_& module, const char* name, const char* doc) {
  Class type(module, name, doc);
  pybind11::detail::get_type_info(typeid(typename Class::type))->operator_new =
      [](std::size_t) -> void* {
    const pybind11::str of = pybind11::type::of<typename Class::type>().attr("__name__");
    throw pybind11::type_error("this " + std::string(of) +
                               " was never initialised: its __init__() has not been called");
  };
  type.def("__reduce__", &reduced);
  return type;
}

}  // namespace limitsurf::python
