// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "numbers.h"

namespace limitsurf::python {

/// An argument that is a text, in UTF-8. Python's texts may contain single surrogates, which UTF-8
/// cannot hold and at which pybind11 gives up: they stand here as Python writes them, "\ud800".
class Text {
 public:
  explicit Text(std::string text = {}) : text_(std::move(text)) {}
  operator const std::string&() const { return text_; }

 private:
  std::string text_;
};

class TextCaster {
 public:
  PYBIND11_TYPE_CASTER(Text, pybind11::detail::const_name("str"));

  bool load(pybind11::handle source, bool /*convert*/) {
    if (!source || !PyUnicode_Check(source.ptr())) {
      return false;
    }
    const auto bytes = pybind11::reinterpret_steal<pybind11::bytes>(
        PyUnicode_AsEncodedString(source.ptr(), "utf-8", "backslashreplace"));
    if (!bytes) {
      throw pybind11::error_already_set();
    }
    value = Text(bytes);
    return true;
  }
};

}  // namespace limitsurf::python

namespace pybind11::detail {

template <>
class type_caster<limitsurf::python::Text> : public limitsurf::python::TextCaster {};

}  // namespace pybind11::detail
