// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>
#include <typeinfo>

namespace limitsurf::python {

/// A new class of the module, a py::class_. Python can make an object without initialising it
/// (`cls.__new__(cls)`), for which pybind11 would allocate memory when a function first takes it:
/// such objects raise TypeError instead.
///
/// Protocols 0 and 1 of pickle would make an object of pybind11's base class, which ends the
/// process. Objects are reduced as for protocol 2 instead: those that do not pickle raise
/// TypeError.
template <typename Class>
Class boundClass(pybind11::module_& module, const char* name, const char* doc) {
  Class type(module, name, doc);
  pybind11::detail::get_type_info(typeid(typename Class::type))->operator_new =
      [](std::size_t) -> void* {
    const pybind11::str of = pybind11::type::of<typename Class::type>().attr("__name__");
    throw pybind11::type_error("this " + std::string(of) +
                               " was never initialised: its __init__() has not been called");
  };
  type.def("__reduce_ex__", [](const pybind11::object& self, int protocol) {
    constexpr int kLeastProtocol = 2;
    const pybind11::object base = pybind11::module_::import("builtins").attr("object");
    return base.attr("__reduce_ex__")(self, std::max(protocol, kLeastProtocol));
  });
  return type;
}

}  // namespace limitsurf::python
