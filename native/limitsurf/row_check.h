// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace limitsurf {

/// Throws std::invalid_argument, which names both numbers, unless an array has the expected number
/// of rows. `like` names another array that has so many, if there is one.
inline void checkRows(const char* what, Eigen::Index rows, Eigen::Index expected,
                      const char* like = nullptr) {
  if (rows != expected) {
    std::string text = std::string(what) + " has " + std::to_string(rows) +
                       (rows == 1 ? " row" : " rows") + "; expected " + std::to_string(expected);
    if (like) {
      text += std::string(", as many as ") + like + " has";
    }
    throw std::invalid_argument(text);
  }
}

}  // namespace limitsurf
