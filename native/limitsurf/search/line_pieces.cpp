// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/line_pieces.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/number_text.h"

namespace limitsurf {

std::int64_t piecesOfLine(const Vector3& from, const Vector3& to, double spacing) {
  constexpr double kMost = static_cast<double>(kMostPieces) + 1;
  return static_cast<std::int64_t>(
      std::clamp(std::ceil((to - from).stableNorm() / spacing), 1., kMost));
}

std::int64_t countPieces(const Polylines& curves, double spacing, const char* points_name) {
  std::int64_t count = 0;
  forEachLine(curves, [&](const Vector3& from, const Vector3& to) {
    count += piecesOfLine(from, to, spacing);
    if (count > kMostPieces) {
      throw std::invalid_argument(
          std::string(points_name) + ": the curves would be divided into more than " +
          std::to_string(kMostPieces) + " pieces, because each may be " + numberText(spacing) +
          " long; the line that ends at (" + numberText(to[0]) + ", " + numberText(to[1]) + ", " +
          numberText(to[2]) + ") is " + numberText((to - from).stableNorm()) + " long");
    }
  });
  return count;
}

}  // namespace limitsurf
