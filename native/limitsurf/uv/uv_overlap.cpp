// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_overlap.h"

#include <algorithm>
#include <cmath>

#include "limitsurf/pi.h"

namespace limitsurf {
namespace {

constexpr double kTurn = 2 * kPi<double>;
/// Wedges that have at most this angle in common only touch. Radians.
constexpr double kTouching = 1e-4;

/// A wedge as the angle at which it begins and its width.
struct Angles {
  explicit Angles(const Wedge& wedge) : begin(std::atan2(wedge.first[1], wedge.first[0])) {
    width = std::atan2(wedge.last[1], wedge.last[0]) - begin;
    width += width < 0 ? kTurn : 0;
    // A corner or a side of a cell spans half a turn at most: a wider wedge is an empty one that
    // rounding has turned inside out.
    width = width > kMostWidth ? 0 : width;
  }
  double begin, width;

 private:
  static constexpr double kMostWidth = 0.75 * kTurn;
};

bool overlap(const Angles& a, const Angles& b) {
  double from = b.begin - a.begin;
  from += from < 0 ? kTurn : 0;
  const double common = std::max(0., std::min(a.width, from + b.width) - from) +
                        std::max(0., std::min(a.width, from + b.width - kTurn));
  return common > kTouching;
}

}  // namespace

bool doWedgesOverlap(const BorderFind* begin, const BorderFind* end) {
  for (const BorderFind* one = begin; one != end; ++one) {
    for (const BorderFind* other = begin; other != one; ++other) {
      for (int i = 0; i < one->wedge_count; ++i) {
        for (int j = 0; j < other->wedge_count; ++j) {
          if (overlap(Angles(one->wedges[i]), Angles(other->wedges[j]))) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

}  // namespace limitsurf
