// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_cell_inverse.h"

#include <algorithm>

namespace limitsurf {
namespace {

/// From the Bezier points of a cubic, `stride` apart, to its coefficients of powers about the
/// middle.
void toPowers(Point2* p, int stride) {
  const Point2 a = p[0], b = p[stride], c = p[2 * stride], d = p[3 * stride];
  p[0] = 0.125 * ((a + d) + 3 * (b + c));
  p[stride] = 0.75 * ((d - a) + (c - b));
  p[2 * stride] = 1.5 * ((a - b) + (d - c));
  p[3 * stride] = (d - a) + 3 * (b - c);
}

/// The control points of the derivatives of a bicubic patch.
struct DerivativePoints {
  explicit DerivativePoints(const Point2* p) {
    for (int i = 0; i < 12; ++i) {
      const int begin = i / 3 * 4 + i % 3;
      ds[i] = 3 * (p[begin + 1] - p[begin]);
      dt[i] = 3 * (p[i + 4] - p[i]);
      mean_s += ds[i] / 12;
      mean_t += dt[i] / 12;
    }
  }

  /// A bound on |ss| + 2 |st| + |tt|, from the control points of the second derivatives.
  Point2 secondBound() const {
    Point2 ss = Point2::Zero(), st = Point2::Zero(), tt = Point2::Zero();
    for (int row = 0; row < 4; ++row) {
      for (int i = 0; i < 2; ++i) {
        ss = ss.max((ds[3 * row + i + 1] - ds[3 * row + i]).abs());
        tt = tt.max((dt[4 * (i + 1) + row] - dt[4 * i + row]).abs());
      }
    }
    for (int row = 0; row < 3; ++row) {
      for (int i = 0; i < 3; ++i) {
        st = st.max((ds[3 * (row + 1) + i] - ds[3 * row + i]).abs());
      }
    }
    return 2 * ss + 6 * st + 2 * tt;
  }

  Point2 ds[12], dt[12];  ///< four rows of three, and three rows of four
  Point2 mean_s = Point2::Zero(), mean_t = Point2::Zero();
};

}  // namespace

bool CellInverse::set(const UvCell& cell, const Point2& tolerance) {
  const DerivativePoints derivatives(cell.points);
  const double determinant = cross(derivatives.mean_s, derivatives.mean_t);
  if (determinant == 0) {
    return false;
  }
  m_s_ = Point2(derivatives.mean_t[1], -derivatives.mean_s[1]) / determinant;
  m_t_ = Point2(-derivatives.mean_t[0], derivatives.mean_s[0]) / determinant;
  const double variation = variationOf(derivatives.ds, derivatives.dt);
  if (!(variation <= kMostVariation)) {
    return false;
  }
  const double newton = 2 * variation / (1 - variation);
  contraction_ = newton / (1 - newton);
  setTolerance(tolerance, derivatives.secondBound());
  setPowers(cell.points);
  return true;
}

double CellInverse::variationOf(const Point2 ds[12], const Point2 dt[12]) const {
  Point2 from_s = Point2::Zero(), from_t = Point2::Zero();  // the entries of M J - 1, by columns
  for (int i = 0; i < 12; ++i) {
    from_s = from_s.max((ds[i][0] * m_s_ + ds[i][1] * m_t_ - Point2(1, 0)).abs());
    from_t = from_t.max((dt[i][0] * m_s_ + dt[i][1] * m_t_ - Point2(0, 1)).abs());
  }
  return (from_s + from_t).maxCoeff();
}

void CellInverse::setTolerance(const Point2& tolerance, const Point2& second) {
  tolerance_ = tolerance;
  // Newton's error is half the second derivative times the squared step; a quarter of the tolerance
  // is allowed for it.
  curvature_ = 2 * (second / tolerance).maxCoeff();
  const double m_norm = (m_s_.abs() * tolerance[0] + m_t_.abs() * tolerance[1]).maxCoeff();
  border_width_ = 8 * m_norm;
}

void CellInverse::setPowers(const Point2* points) {
  std::copy(points, points + 16, c_);
  for (int i = 0; i < 4; ++i) {
    toPowers(c_ + 4 * i, 1);
  }
  for (int i = 0; i < 4; ++i) {
    toPowers(c_ + i, 4);
  }
}

Point2 CellInverse::guess(const Point2& target) const {
  const Point2 r = target - c_[0];
  return r[0] * m_s_ + r[1] * m_t_;
}

inline void CellInverse::evaluate(const Point2& x, const Point2& target, Point2& rest, Point2& ds,
                                  Point2& dt) const {
  const double s = x[0], t = x[1];
  Point2 row[4], row_ds[4];
  for (int j = 0; j < 4; ++j) {
    const Point2* c = c_ + 4 * j;
    const Point2 c3s = s * c[3], high = s * (c[2] + c3s);
    row[j] = s * (c[1] + high);
    row_ds[j] = (c[1] + high) + s * (c[2] + 2 * c3s);
  }
  // The constant terms are added last, since what they leave of the target is small.
  for (int j = 1; j < 4; ++j) {
    row[j] += c_[4 * j];
  }
  const Point2 r3t = t * row[3], high = t * (row[2] + r3t);
  rest = (target - c_[0]) - (row[0] + t * (row[1] + high));
  dt = (row[1] + high) + t * (row[2] + 2 * r3t);
  ds = row_ds[0] + t * (row_ds[1] + t * (row_ds[2] + t * row_ds[3]));
}

void CellInverse::derivatives(const Point2& x, Point2& ds, Point2& dt) const {
  Point2 unused;
  evaluate(x, Point2::Zero(), unused, ds, dt);
}

bool CellInverse::find(const Point2& target, Place& out) const {
  out.x = out.x.max(-0.5).min(0.5);
  for (int step = 0; step < kMostSteps; ++step) {
    Point2 rest;
    evaluate(out.x, target, rest, out.ds, out.dt);
    out.determinant = cross(out.ds, out.dt);
    const Point2 move = Point2(cross(rest, out.dt), cross(out.ds, rest)) / out.determinant;
    out.beyond = out.x + move;
    out.x = out.beyond.max(-0.5).min(0.5);
    const Point2 outside = out.beyond - out.x;
    const double length = move.abs().maxCoeff();
    if (curvature_ * length * length <= 1) {
      return ((out.ds * outside[0] + out.dt * outside[1]).abs() <= tolerance_).all();
    }
    if (outside.abs().maxCoeff() > contraction_ * length) {
      return false;
    }
  }
  return false;
}

}  // namespace limitsurf
