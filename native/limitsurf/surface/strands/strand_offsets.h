// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limitsurf {

/// Throws std::invalid_argument unless `offsets` are n + 1 numbers for n strands, begin with 0 and
/// do not decrease.
void checkOffsets(const std::vector<std::int64_t>& offsets, std::size_t strands);

}  // namespace limitsurf
