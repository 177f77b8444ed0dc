// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/polylines.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "limitsurf/search/checks.h"

namespace limitsurf {

void checkPolylines(const Polylines& curves, const char* points_name, const char* offsets_name) {
  const auto& offsets = curves.offsets;
  if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end()) ||
      offsets.back() != curves.points.rows()) {
    throw std::invalid_argument(std::string(offsets_name) +
                                " must begin with 0, must not decrease, and must end with the "
                                "number of rows of " +
                                points_name + ", " + std::to_string(curves.points.rows()));
  }
  checkFinite(curves.points, points_name);
}

}  // namespace limitsurf
