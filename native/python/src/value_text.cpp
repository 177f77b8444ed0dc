// SPDX-License-Identifier: Apache-2.0
#include "value_text.h"

#include <algorithm>
#include <string_view>

#include "text.h"

namespace limitsurf::python {

namespace py = pybind11;

namespace {

/// The number of bytes of the line break that a text of UTF-8 begins with; 0 without one. These are
/// the breaks of Python's str.splitlines().
std::size_t breakSize(std::string_view text) {
  const char first = text.front();
  if ((first >= '\n' && first <= '\r') || (first >= '\x1c' && first <= '\x1e')) {
    return 1;
  }
  for (const std::string_view longer : {"\xc2\x85", "\xe2\x80\xa8", "\xe2\x80\xa9"}) {
    if (text.substr(0, longer.size()) == longer) {
      return longer.size();
    }
  }
  return 0;
}

/// The text with one space instead of line breaks and of the indentation after them; of a long one
/// only the beginning, of `most` bytes and some more.
std::string inOneLine(std::string_view text, std::size_t most) {
  std::string line;
  while (!text.empty() && line.size() < most + 4) {
    std::size_t broken = breakSize(text);
    if (broken == 0) {
      line += text.front();
      text.remove_prefix(1);
      continue;
    }
    line += ' ';
    for (; broken > 0; broken = text.empty() ? 0 : breakSize(text)) {
      text.remove_prefix(broken);
      text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    }
  }
  return line;
}

/// Whether a value is a truth value or a number of numpy, as the elements of arrays are. numpy 2
/// represents them as calls, np.False_ or np.float64(1.5), which nobody wrote who made an array.
bool isElement(const py::handle& value) {
  return isBool(value) || py::isinstance(value, py::module_::import("numpy").attr("number"));
}

}  // namespace

std::string shortened(const std::string& text) {
  constexpr std::size_t kMost = 80;
  const std::string line = inOneLine(text, kMost);
  std::size_t end = kMost;
  if (line.size() <= end) {
    return line;
  }
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0) == 0x80) {
    --end;  // within a character of several bytes
  }
  return line.substr(0, end) + "...";
}

std::string valueText(const py::handle& value) {
  if (PyLong_Check(value.ptr()) && !PyBool_Check(value.ptr()) &&
      py::cast<int>(value.attr("bit_length")()) > 200) {
    return "an integer of " + py::cast<std::string>(py::str(value.attr("bit_length")())) + " bits";
  }
  try {
    return shortened(py::cast<Text>(isElement(value) ? py::str(value) : py::repr(value)));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) {
      throw;
    }
    return "an object of the class " + shortened(Py_TYPE(value.ptr())->tp_name);
  }
}

}  // namespace limitsurf::python
