// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_cell.h"

#include <algorithm>

#include "limitsurf/surface/bezier_patch.h"

namespace limitsurf {
namespace {

/// From the Bezier points of a cubic, `stride` apart, to those of its halves.
void halveCubic(const Point2* p, int stride, Point2* low, Point2* high) {
  const Point2 ab = 0.5 * (p[0] + p[stride]), bc = 0.5 * (p[stride] + p[2 * stride]),
               cd = 0.5 * (p[2 * stride] + p[3 * stride]);
  const Point2 abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd);
  const Point2 first = p[0], last = p[3 * stride];
  low[0] = first;
  low[stride] = ab;
  low[2 * stride] = abc;
  low[3 * stride] = high[0] = 0.5 * (abc + bcd);
  high[stride] = bcd;
  high[2 * stride] = cd;
  high[3 * stride] = last;
}

}  // namespace

Box2 UvCell::box() const {
  Box2 box;
  for (const Point2& point : points) {
    box.include(point);
  }
  return box;
}

void UvCell::halve(int direction, UvCell out[2]) const {
  const int along = direction == 0 ? 1 : 4, across = 5 - along;
  for (int i = 0; i < 4; ++i) {
    const int first = i * across;
    halveCubic(points + first, along, out[0].points + first, out[1].points + first);
  }
  for (int i = 0; i < 2; ++i) {
    out[i].size = size;
    out[i].size[direction] *= 0.5;
    out[i].low = low;
    out[i].low[direction] += i * out[i].size[direction];
  }
}

void UvCell::quarter(UvCell out[4]) const {
  UvCell sides[2], columns[2];
  halve(0, sides);
  for (int side = 0; side < 2; ++side) {
    sides[side].halve(1, columns);
    out[side] = columns[0];
    out[2 + side] = columns[1];
  }
}

void UvCell::evaluate(double s, double t, Point2& value, Point2& ds, Point2& dt) const {
  Point2 row[4], row_ds[4], unused;
  for (int i = 0; i < 4; ++i) {
    const Point2* p = points + 4 * i;
    bezier::cubic<1>(p[0], p[1], p[2], p[3], s, row[i], row_ds[i], unused);
  }
  bezier::cubic<1>(row[0], row[1], row[2], row[3], t, value, dt, unused);
  bezier::cubic<0>(row_ds[0], row_ds[1], row_ds[2], row_ds[3], t, ds, unused, unused);
}

JacobianBounds::JacobianBounds(const UvCell& cell) {
  // Product of Bernstein polynomials: the binomials of the factors over those of the product.
  constexpr double kOf2[3] = {1, 2, 1}, kOf3[4] = {1, 3, 3, 1}, kOf5[6] = {1, 5, 10, 10, 5, 1};
  const Point2* p = cell.points;
  double sums[6][6] = {};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Point2 ds = 3 * (p[4 * j + i + 1] - p[4 * j + i]);
      for (int l = 0; l < 3; ++l) {
        for (int k = 0; k < 4; ++k) {
          const Point2 dt = 3 * (p[4 * l + 4 + k] - p[4 * l + k]);
          sums[j + l][i + k] += kOf2[i] * kOf3[k] * kOf3[j] * kOf2[l] * cross(ds, dt);
        }
      }
    }
  }
  least = std::numeric_limits<double>::infinity();
  largest = -least;
  for (int b = 0; b < 6; ++b) {
    for (int a = 0; a < 6; ++a) {
      const double coefficient = sums[b][a] / (kOf5[a] * kOf5[b]);
      least = std::min(least, coefficient);
      largest = std::max(largest, coefficient);
    }
  }
}

}  // namespace limitsurf
