// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <type_traits>

#include "limitsurf/error.h"
#include "limitsurf/number_text.h"

namespace limitsurf {

/// The parts one after the other, numbers as their callers wrote them.
template <typename... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  const auto add = [&](const auto& part) {
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(part)>>) {
      stream << numberText(part);
    } else {
      stream << part;
    }
  };
  (add(parts), ...);
  return stream.str();
}

/// Throws a MeshError whose message consists of the parts.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw MeshError(text(parts...));
}

}  // namespace limitsurf
