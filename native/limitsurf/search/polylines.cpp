// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/polylines.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/search/checks.h"

namespace limitsurf {

void checkPolylines(const Polylines& curves) {
  const auto& offsets = curves.offsets;
  if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()) ||
      offsets.back() != curves.points.rows()) {
    throw std::invalid_argument(
        "offsets must begin with 0, must not decrease, and must end with the number of points, " +
        std::to_string(curves.points.rows()));
  }
  checkFinite(curves.points, "point");
}

}  // namespace limitsurf
