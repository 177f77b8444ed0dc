// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

namespace limitsurf {

/// Throws std::invalid_argument, which names both numbers, unless an array has the expected number
/// of rows.
inline void checkRows(const char* what, Eigen::Index rows, Eigen::Index expected) {
  if (rows != expected) {
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(rows) +
                                " rows; expected " + std::to_string(expected));
  }
}

}  // namespace limitsurf
