// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/search/closest_so_far.h"

#include <algorithm>

namespace limitsurf {

SearchPoint::SearchPoint(const Vector3& point, const Vector3& middle, double diagonal)
    : place(point) {
  const Vector3 from_middle = point - middle;
  const double length = from_middle.norm();
  if (length > kFarAway * diagonal && diagonal > 0) {
    place = middle;
    away = from_middle * std::min(1., kFarthest * diagonal / length);
    range = away.norm();
  }
}

}  // namespace limitsurf
