// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <typeinfo>

namespace limitsurf::python {

/// A new class of the module, a py::class_. Python can make an object without initialising it
/// (`cls.__new__(cls)`), for which pybind11 would allocate memory when a function first takes it:
/// such objects raise TypeError instead.
template <typename Class>
Class boundClass(pybind11::module_& module, const char* name, const char* doc) {
  Class type(module, name, doc);
  pybind11::detail::get_type_info(typeid(typename Class::type))->operator_new =
      [](std::size_t) -> void* {
    const pybind11::str of = pybind11::type::of<typename Class::type>().attr("__name__");
    throw pybind11::type_error("this " + std::string(of) +
                               " was never initialised: its __init__() has not been called");
  };
  return type;
}

}  // namespace limitsurf::python
