// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/polylines.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace limitsurf {

void checkPolylines(const Polylines& curves) {
  const auto& offsets = curves.offsets;
  if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()) ||
      offsets.back() != curves.points.rows()) {
    throw std::invalid_argument(
        "offsets must begin with 0, must not decrease, and must end with the number of points, " +
        std::to_string(curves.points.rows()));
  }
  for (Eigen::Index row = 0; row < curves.points.rows(); ++row) {
    if (!curves.points.row(row).allFinite()) {
      throw std::invalid_argument("row " + std::to_string(row) + ": the point is not finite");
    }
  }
}

}  // namespace limitsurf
