// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limitsurf/number_text.h"
#include "limitsurf/pi.h"

namespace limitsurf {
namespace {

[[noreturn]] void refuse(const char* name, Eigen::Index row, const PointRows& rows,
                         const char* reason) {
  std::ostringstream message;
  message << "row " << row << ": " << name << " is (" << numberText(rows(row, 0)) << ", "
          << numberText(rows(row, 1)) << ", " << numberText(rows(row, 2)) << "), which " << reason;
  throw std::invalid_argument(message.str());
}

/// Whether all numbers are finite and, times `scale`, at most `most`.
bool areAllWithin(const PointRows& rows, double scale, double most) {
  double largest = 0, products = 0;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      products += 0 * rows(row, axis);  // becomes NaN if one is infinite or NaN
      largest = std::max(largest, std::abs(rows(row, axis)));
    }
  }
  return products == 0 && scale * largest <= most;
}

}  // namespace

void checkFinite(const PointRows& rows, const char* name, double scale) {
  if (areAllWithin(rows, scale, kFarthestPoint)) {
    return;
  }
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    if (!rows.row(row).allFinite()) {
      refuse(name, row, rows, "is not finite");
    }
    if (scale * rows.row(row).cwiseAbs().maxCoeff() > kFarthestPoint) {
      const std::string most = numberText(kFarthestPoint / scale);
      refuse(name, row, rows, ("is too far away: coordinates may go up to " + most).c_str());
    }
  }
}

void checkDirections(const PointRows& rows, const char* name) {
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    if (!rows.row(row).allFinite()) {
      refuse(name, row, rows, "is not finite");
    }
    if ((rows.row(row).array() == 0).all()) {
      refuse(name, row, rows, "has no length");
    }
  }
}

void checkDistance(double max_distance) {
  if (!(max_distance >= 0)) {
    throw std::invalid_argument("max_distance is " + numberText(max_distance) +
                                "; it must be 0 or more");
  }
}

void checkAngle(double max_angle) {
  if (!(max_angle >= 0 && max_angle <= std::nextafter(kPi<double>, 4.))) {
    throw std::invalid_argument("max_angle is " + numberText(max_angle) +
                                "; it must be between 0 and pi");
  }
}

}  // namespace limitsurf
