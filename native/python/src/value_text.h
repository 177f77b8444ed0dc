// SPDX-License-Identifier: Apache-2.0
//
// Values in messages, which are one line each.
#pragma once

#include <string>

#include "numbers.h"

namespace limitsurf::python {

/// Text for a message: one line; a long one ends in dots.
std::string shortened(const std::string& text);

/// A value for a message, as Python writes it, or its class if that raises. Integers of thousands
/// of digits cannot be written. Numbers of numpy are written as Python's.
std::string valueText(const pybind11::handle& value);

}  // namespace limitsurf::python
