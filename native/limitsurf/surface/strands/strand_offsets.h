// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limitsurf {

/// Throws std::invalid_argument, which names the argument, unless it has as many rows as expected.
void checkRows(const char* what, Eigen::Index rows, Eigen::Index expected);

/// Throws std::invalid_argument unless `offsets` are n + 1 numbers for n strands, begin with 0 and
/// do not decrease.
void checkOffsets(const std::vector<std::int64_t>& offsets, std::size_t strands);

}  // namespace limitsurf
