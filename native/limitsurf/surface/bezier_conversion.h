// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limitsurf/surface/jet.h"

namespace limitsurf {

/// Replaces the uniform B-spline control points p0..p3, which are `stride` apart, by the Bezier
/// points of the middle span.
template <typename Point>
void toBezier(Point* p, int stride) {
  // Products with rounded numbers take a fifth of the time of divisions, and are as exact beside p1
  // and p2, which lie close together.
  constexpr double kThird = 1. / 3, kSixth = 1. / 6;
  const Point p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
  const Point side = p2 - p1;
  p[0] = p1 + kSixth * ((p0 - p1) + side);
  p[stride] = p1 + kThird * side;
  p[2 * stride] = p2 - kThird * side;
  p[3 * stride] = p2 + kSixth * ((p3 - p2) - side);
}

/// Replaces the values of a cubic at 0, 1/3, 2/3 and 1 by its Bezier coefficients.
inline void interpolateBezier(Padded* p, int stride) {
  const Padded p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
  p[stride] = (-5 * p0 + 18 * p1 - 9 * p2 + 2 * p3) / 6;
  p[2 * stride] = (2 * p0 - 9 * p1 + 18 * p2 - 5 * p3) / 6;
}

/// Applies `convert` to the rows and then to the columns of 4 x 4 points.
template <typename Point, typename Convert>
void convertBothWays(Point points[16], const Convert& convert) {
  for (int i = 0; i < 4; ++i) {
    convert(points + 4 * i, 1);
  }
  for (int i = 0; i < 4; ++i) {
    convert(points + i, 4);
  }
}

/// Fills the missing points of a side by linear continuation (Lacewell & Burley 2007, figure 2).
template <typename Point>
void continueLow(Point* p, int along, int across) {
  for (int i = 0; i < 4; ++i) {
    p[i * along] = 2 * p[i * along + across] - p[i * along + 2 * across];
  }
}

/// Fills the missing points of all sides that have none.
template <typename Point>
void continueSides(Point window[16], bool x_low, bool x_high, bool y_low, bool y_high) {
  if (x_low) {
    continueLow(window, 4, 1);
  }
  if (x_high) {
    continueLow(window + 3, 4, -1);
  }
  if (y_low) {
    continueLow(window, 1, 4);
  }
  if (y_high) {
    continueLow(window + 12, 1, -4);
  }
}

}  // namespace limitsurf
