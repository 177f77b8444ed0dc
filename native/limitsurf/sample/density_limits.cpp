// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/sample/density_limits.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "limitsurf/number_text.h"
#include "limitsurf/surface/patches/face_squares.h"

namespace limitsurf {
namespace {

/// The squares that a coordinate lies in: two where it is on the border between them.
FaceSquares around(double x, int side) {
  const int first = std::max(static_cast<int>(std::ceil(x * side)) - 1, 0);
  return {first, std::min(static_cast<int>(x * side), side - 1)};
}

}  // namespace

DensityLimits::DensityLimits(int side, std::vector<double> values)
    : side_(side), values_(std::move(values)) {
  if (side < 1 || side > kMostSide || (side & (side - 1)) != 0) {
    throw std::invalid_argument("density limits have " + std::to_string(side) +
                                " squares on each side of a face; expected a power of two from 1 "
                                "to " +
                                std::to_string(kMostSide));
  }
  const std::size_t squares = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  if (values_.size() % squares != 0) {
    throw std::invalid_argument(std::to_string(values_.size()) + " density limits are not " +
                                std::to_string(squares) + " for each face");
  }
}

std::int64_t DensityLimits::faceCount() const {
  const std::int64_t side = side_;
  return areKnown() ? static_cast<std::int64_t>(values_.size()) / (side * side) : 0;
}

DensityLimits::Range DensityLimits::on(int face, double u0, double u1, double v0, double v1) const {
  const FaceSquares columns = squaresBetween(u0, u1, side_), rows = squaresBetween(v0, v1, side_);
  Range range{value(face, rows.first, columns.first), 0};
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      const double limit = value(face, row, column);
      if (!(limit >= 0 && std::isfinite(limit))) {
        std::ostringstream message;
        message << "density_limits is " << numberText(limit) << " at face " << face << ", row "
                << row << ", column " << column << "; it must be finite and at least 0";
        throw std::invalid_argument(message.str());
      }
      range.least = std::min(range.least, limit);
      range.largest = std::max(range.largest, limit);
    }
  }
  return range;
}

double DensityLimits::at(const Location& location) const {
  const FaceSquares columns = around(location.u, side_), rows = around(location.v, side_);
  double limit = 0;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int column = columns.first; column <= columns.last; ++column) {
      limit = std::max(limit, value(location.face, row, column));
    }
  }
  return limit;
}

}  // namespace limitsurf
