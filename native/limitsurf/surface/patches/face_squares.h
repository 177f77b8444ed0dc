// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace limitsurf {

/// Some of the equal squares along one side of a Ptex face, the first and the last.
struct FaceSquares {
  int first, last;
};

/// The squares of which an interval contains a part: those that it only touches do not count.
inline FaceSquares squaresBetween(double low, double high, int side) {
  const int first = std::clamp(static_cast<int>(low * side), 0, side - 1);
  return {first, std::clamp(static_cast<int>(std::ceil(high * side)) - 1, first, side - 1)};
}

}  // namespace limitsurf
