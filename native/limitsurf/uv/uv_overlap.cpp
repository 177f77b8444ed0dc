// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limitsurf/pi.h"

namespace limitsurf {
namespace {

constexpr double kTurn = 2 * kPi<double>;
/// Wedges that have at most this angle in common only touch. Radians.
constexpr double kTouching = 1e-4;

/// A corner or a side of a cell spans half a turn at most: a wider wedge is an empty one that
/// rounding has turned inside out.
constexpr double kMostWidth = 0.75 * kTurn;

double angleOf(const Point2& direction) { return std::atan2(direction[1], direction[0]); }

}  // namespace

void WedgeOverlap::add(const BorderFind& find) {
  for (int i = 0; i < find.wedge_count; ++i) {
    const double begin = angleOf(find.wedges[i].first);
    double width = angleOf(find.wedges[i].last) - begin;
    width += width < 0 ? kTurn : 0;
    width = width > kMostWidth ? 0 : width;
    // Twice, a turn apart: a later wedge may reach over the end of the turn into an earlier one.
    arcs_.push_back({begin, begin + width, &find});
    arcs_.push_back({begin + kTurn, begin + kTurn + width, &find});
  }
}

bool WedgeOverlap::of(const BorderFind* begin, const BorderFind* end) {
  if (end - begin < 2) {
    return false;
  }
  arcs_.clear();
  for (const BorderFind* find = begin; find != end; ++find) {
    add(*find);
  }
  std::sort(arcs_.begin(), arcs_.end(), [](const Arc& a, const Arc& b) {
    return a.begin < b.begin || (a.begin == b.begin && a.end < b.end);
  });
  // Of the arcs so far: the one that reaches farthest, and the one of another find that does.
  Arc first = arcs_[0];
  double second_end = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < arcs_.size(); ++i) {
    const Arc& arc = arcs_[i];
    const double reached = arc.find == first.find ? second_end : first.end;
    if (std::min(reached, arc.end) - arc.begin > kTouching) {
      return true;
    }
    if (arc.find == first.find) {
      first.end = std::max(first.end, arc.end);
    } else if (arc.end > first.end) {
      second_end = first.end;
      first = arc;
    } else {
      second_end = std::max(second_end, arc.end);
    }
  }
  return false;
}

}  // namespace limitsurf
