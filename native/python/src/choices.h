// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "limitsurf/error.h"

namespace limitsurf::python {

/// The names of an enum's values.
template <typename Enum>
using Choices = std::vector<std::pair<const char*, Enum>>;

/// MeshError that tells the known names where `value` is none of them.
template <typename Enum>
Enum choice(const std::string& value, const char* name, const Choices<Enum>& choices) {
  std::string known;
  for (const auto& [text, result] : choices) {
    if (value == text) {
      return result;
    }
    known += std::string(known.empty() ? "'" : " or '") + text + "'";
  }
  throw MeshError(std::string(name) + " is '" + value + "'; expected " + known);
}

}  // namespace limitsurf::python
