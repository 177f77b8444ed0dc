// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/path/space_curves.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitsurf/row_check.h"
#include "limitsurf/search/checks.h"

namespace limitsurf {

std::int64_t SpaceCurves::segments(std::size_t curve) const {
  const std::int64_t count = offsets[curve + 1] - offsets[curve];
  return closed[curve] && count > 1 ? count : count - 1;
}

std::int64_t SpaceCurves::end(std::size_t curve, std::int64_t segment) const {
  const std::int64_t next = offsets[curve] + segment + 1;
  return next == offsets[curve + 1] ? offsets[curve] : next;
}

Vector3 SpaceCurves::at(std::size_t curve, double place) const {
  const std::int64_t last = std::max<std::int64_t>(segments(curve) - 1, 0);
  const std::int64_t segment = std::min(static_cast<std::int64_t>(std::floor(place)), last);
  const double t = place - static_cast<double>(segment);
  const Eigen::Index a = offsets[curve] + segment;
  const Eigen::Index b = segments(curve) > 0 ? end(curve, segment) : a;
  if (!isBezier()) {
    return (1 - t) * points.row(a).transpose() + t * points.row(b).transpose();
  }
  return bezierPoint({points.row(a), after.row(a), before.row(b), points.row(b)}, t);
}

void SpaceCurves::check() const {
  checkFinite(points, "points");
  if (before.rows() > 0 || after.rows() > 0) {
    checkRows("handle_left", before.rows(), points.rows(), "points");
    checkRows("handle_right", after.rows(), points.rows(), "points");
    checkFinite(before, "handle_left");
    checkFinite(after, "handle_right");
  }
  if (offsets.empty() || offsets.front() != 0 || offsets.back() != points.rows()) {
    throw std::invalid_argument("offsets must begin with 0 and end with the number of points, " +
                                std::to_string(points.rows()));
  }
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    if (offsets[i] <= offsets[i - 1]) {
      throw std::invalid_argument("offsets[" + std::to_string(i) + "] is " +
                                  std::to_string(offsets[i]) + ", which is not more than " +
                                  std::to_string(offsets[i - 1]) + " before it");
    }
  }
  if (closed.size() + 1 != offsets.size()) {
    throw std::invalid_argument("closed has " + std::to_string(closed.size()) +
                                " values; expected one for each of " +
                                std::to_string(offsets.size() - 1) + " curves");
  }
}

Vector3 bezierPoint(const Vector3 (&points)[4], double t) {
  const double s = 1 - t;
  return s * s * s * points[0] + 3 * s * s * t * points[1] + 3 * s * t * t * points[2] +
         t * t * t * points[3];
}

}  // namespace limitsurf
