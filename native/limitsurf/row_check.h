// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
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

/// The caller's memory for rows of numbers (EvaluationArrays::Rows), or none if they are not
/// wanted.
template <typename Rows>
auto* checkedNumbers(const char* what, const Rows& rows, std::size_t expected, bool are_wanted) {
  if (are_wanted) {
    checkRows(what, static_cast<Eigen::Index>(rows.count), static_cast<Eigen::Index>(expected));
  }
  return are_wanted ? rows.numbers : nullptr;
}

}  // namespace limitsurf
