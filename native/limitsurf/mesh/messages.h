// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

#include "limitsurf/error.h"

namespace limitsurf {

/// The parts one after the other, with all digits of numbers.
template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  stream.precision(17);
  (stream << ... << parts);
  return stream.str();
}

/// Throws a MeshError whose message consists of the parts.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw MeshError(text(parts...));
}

}  // namespace limitsurf
