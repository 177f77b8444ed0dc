// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/strands/strand_offsets.h"

#include <stdexcept>
#include <string>

namespace limitsurf {

void checkOffsets(const std::vector<std::int64_t>& offsets, std::size_t strands) {
  if (offsets.size() != strands + 1) {
    throw std::invalid_argument("there are " + std::to_string(offsets.size()) + " offsets for " +
                                std::to_string(strands) + " strands; expected " +
                                std::to_string(strands + 1));
  }
  if (offsets[0] != 0) {
    throw std::invalid_argument("offsets[0] is " + std::to_string(offsets[0]) + "; expected 0");
  }
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    if (offsets[i] < offsets[i - 1]) {
      throw std::invalid_argument("offsets[" + std::to_string(i) + "] is " +
                                  std::to_string(offsets[i]) + ", less than the one before it, " +
                                  std::to_string(offsets[i - 1]));
    }
  }
}

}  // namespace limitsurf
