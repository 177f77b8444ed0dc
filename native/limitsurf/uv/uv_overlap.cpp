// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_overlap.h"

#include <algorithm>
#include <cmath>

namespace limitsurf {
namespace {

constexpr double kTurn = 6.283185307179586;
/// Wedges that have no more than this in common only touch. Radians.
constexpr double kTouching = 1e-4;

struct Angles {
  explicit Angles(const Wedge& wedge) : begin(std::atan2(wedge.first[1], wedge.first[0])) {
    width = std::atan2(wedge.last[1], wedge.last[0]) - begin;
    width += width < 0 ? kTurn : 0;
    // A cell's corner or side spans half a turn at most: this is a wedge that rounding has turned.
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
