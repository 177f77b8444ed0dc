// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "limitsurf/error.h"

namespace limitsurf::python {

/// The names of the values of an enum.
template <typename Enum>
using Choices = std::vector<std::pair<const char*, Enum>>;

/// The value of the name `value`. Throws MeshError listing the known names if it is none of them.
template <typename Enum>
Enum choice(const std::string& value, const char* name, const Choices<Enum>& choices) {
  std::string known;
  for (const auto& [text, result] : choices) {
    if (value == text) {
      return result;
    }
    known += std::string(known.empty() ? "'" : " or '") + text + "'";
  }
  throw MeshError(std::string(name) + " is '" + shortened(value) + "'; expected " + known);
}

}  // namespace limitsurf::python
