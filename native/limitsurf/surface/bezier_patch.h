// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "limitsurf/surface/pose/padded.h"
#include "limitsurf/types.h"

namespace limitsurf {

/// A rectangle on a Ptex face, with parameters (s, t) in [0, 1]^2 of its own: u = u0 + us s + ut t,
/// v = v0 + vs s + vt t. It is turned by a multiple of 90 degrees: either us and vt or ut and vs
/// are 0.
struct FaceRectangle {
  int face = -1;
  double u0 = 0, us = 1, ut = 0;
  double v0 = 0, vs = 0, vt = 1;

  Location at(double s, double t) const {
    // Where s or t decreases u or v, rounding may lead out of the face.
    return {face, std::clamp(u0 + us * s + ut * t, 0., 1.),
            std::clamp(v0 + vs * s + vt * t, 0., 1.)};
  }

  /// How far u goes.
  double width() const { return std::abs(us) + std::abs(ut); }

  /// The least and the largest coordinates.
  struct Extent {
    double u0, u1, v0, v1;
  };
  Extent extent() const {
    const Location a = at(0, 0), b = at(1, 1);
    return {std::min(a.u, b.u), std::max(a.u, b.u), std::min(a.v, b.v), std::max(a.v, b.v)};
  }

  /// The part of the rectangle that begins at (s, t).
  FaceRectangle part(double s, double t, double width, double height) const {
    return {face,       u0 + us * s + ut * t, us * width, ut * height, v0 + vs * s + vt * t,
            vs * width, vt * height};
  }
};

/// The sides of a rectangle, as bits.
constexpr unsigned kSideS0 = 1, kSideS1 = 2, kSideT0 = 4, kSideT1 = 8;

/// A rectangle of a Ptex face on which the limit surface is one bicubic polynomial, in Bezier form.
struct BezierPatch {
  /// Three coordinates; the fourth number is 0.
  using Point = Padded;

  /// Value and derivatives with respect to (s, t); the value is relative to the anchor.
  struct Values {
    Point value, ds, dt, dss, dst, dtt;
  };

  Point anchor;      ///< near the patch, so that the points keep the digits of small patches
  Point points[16];  ///< Bezier control points less the anchor, row by row: [4 t + s]
  FaceRectangle on;
  /// Sides (kSideS0, ...) across which the surface is not smooth: boundaries and infinitely sharp
  /// edges.
  unsigned borders = 0;

  /// Value and derivatives up to Order, 0 to 2.
  template <int Order>
  void evaluate(double s, double t, Values& out) const;
};

/// The scalar product of the coordinates, without the padding.
inline double dot(const BezierPatch::Point& a, const BezierPatch::Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

namespace bezier {

/// A cubic's value and derivatives from its Bezier points, by differences: equal points give
/// exactly 0.
template <int Order, typename Point>
inline void cubic(const Point& a, const Point& b, const Point& c, const Point& d, double t,
                  Point& value, Point& first, Point& second) {
  const Point ab = b - a, bc = c - b, cd = d - c;
  const Point abc = ab + t * (bc - ab), bcd = bc + t * (cd - bc);
  if (Order >= 1) {
    first = 3 * (abc + t * (bcd - abc));
  }
  if (Order >= 2) {
    second = 6 * (bcd - abc);
  }
  const Point p = a + t * ab, q = b + t * bc, r = c + t * cd;
  const Point pq = p + t * (q - p), qr = q + t * (r - q);
  value = pq + t * (qr - pq);
}

/// Replaces the Bezier points of a cubic, which are `stride` apart, by those of its part between t0
/// and t1.
template <typename Point>
inline void cut(Point* p, int stride, double t0, double t1) {
  // The blossom of the cubic: each of its three arguments is t0 or t1.
  const auto blossom = [&](double a, double b, double c) -> Point {
    const auto mix = [](const Point& x, const Point& y, double t) -> Point {
      return x + t * (y - x);
    };
    const Point x = mix(p[0], p[stride], a), y = mix(p[stride], p[2 * stride], a),
                z = mix(p[2 * stride], p[3 * stride], a);
    return mix(mix(x, y, b), mix(y, z, b), c);
  };
  const Point q0 = blossom(t0, t0, t0), q1 = blossom(t0, t0, t1), q2 = blossom(t0, t1, t1),
              q3 = blossom(t1, t1, t1);
  p[0] = q0;
  p[stride] = q1;
  p[2 * stride] = q2;
  p[3 * stride] = q3;
}

}  // namespace bezier

template <int Order>
inline void BezierPatch::evaluate(double s, double t, Values& out) const {
  Point row[4], row_ds[4], row_dss[4];
  for (int i = 0; i < 4; ++i) {
    const Point* p = points + 4 * i;
    bezier::cubic<Order>(p[0], p[1], p[2], p[3], s, row[i], row_ds[i], row_dss[i]);
  }
  Point unused;
  bezier::cubic<Order>(row[0], row[1], row[2], row[3], t, out.value, out.dt, out.dtt);
  if (Order >= 1) {
    bezier::cubic<(Order >= 2 ? 1 : 0)>(row_ds[0], row_ds[1], row_ds[2], row_ds[3], t, out.ds,
                                        out.dst, unused);
  }
  if (Order >= 2) {
    bezier::cubic<0>(row_dss[0], row_dss[1], row_dss[2], row_dss[3], t, out.dss, unused, unused);
  }
}

}  // namespace limitsurf
