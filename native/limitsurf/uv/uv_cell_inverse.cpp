// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/uv/uv_cell_inverse.h"

#include <algorithm>

namespace limitsurf {
namespace {

void put(const Point2& from, double to[2]) {
  to[0] = from[0];
  to[1] = from[1];
}

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
  put(Point2(derivatives.mean_t[1], -derivatives.mean_s[1]) / determinant, numbers_.m_s);
  put(Point2(-derivatives.mean_t[0], derivatives.mean_s[0]) / determinant, numbers_.m_t);
  const double variation = variationOf(derivatives.ds, derivatives.dt);
  if (!(variation <= kMostVariation)) {
    return false;
  }
  const double newton = 2 * variation / (1 - variation);
  numbers_.contraction = newton / (1 - newton);
  const double reach = setTolerance(tolerance, derivatives.secondBound());
  numbers_.reach = reach / (1 - variation) / (1 - newton);
  setPowers(cell.points);
  return true;
}

double CellInverse::variationOf(const Point2 ds[12], const Point2 dt[12]) const {
  const Point2 m_s(numbers_.m_s[0], numbers_.m_s[1]), m_t(numbers_.m_t[0], numbers_.m_t[1]);
  Point2 from_s = Point2::Zero(), from_t = Point2::Zero();  // the entries of M J - 1, by columns
  for (int i = 0; i < 12; ++i) {
    from_s = from_s.max((ds[i][0] * m_s + ds[i][1] * m_t - Point2(1, 0)).abs());
    from_t = from_t.max((dt[i][0] * m_s + dt[i][1] * m_t - Point2(0, 1)).abs());
  }
  return (from_s + from_t).maxCoeff();
}

double CellInverse::setTolerance(const Point2& tolerance, const Point2& second) {
  put(tolerance, numbers_.tolerance);
  // Newton's error is half the second derivative times the squared step; a quarter of the tolerance
  // is allowed for it.
  numbers_.curvature = 2 * (second / tolerance).maxCoeff();
  const Point2 m_s(numbers_.m_s[0], numbers_.m_s[1]), m_t(numbers_.m_t[0], numbers_.m_t[1]);
  const double m_norm = (m_s.abs() * tolerance[0] + m_t.abs() * tolerance[1]).maxCoeff();
  border_width_ = 8 * m_norm;
  return m_norm;
}

void CellInverse::setPowers(const Point2* points) {
  Point2 c[16];
  std::copy(points, points + 16, c);
  for (int i = 0; i < 4; ++i) {
    toPowers(c + 4 * i, 1);
  }
  for (int i = 0; i < 4; ++i) {
    toPowers(c + i, 4);
  }
  for (int i = 0; i < 16; ++i) {
    numbers_.coefficients[0][i] = c[i][0];
    numbers_.coefficients[1][i] = c[i][1];
  }
}

void CellInverse::derivatives(const Point2& x, Point2& ds, Point2& dt) const {
  const double s = x[0], t = x[1];
  Point2 row[4], row_ds[4];
  for (int j = 0; j < 4; ++j) {
    const Point2 one = coefficient(4 * j + 1), square = coefficient(4 * j + 2);
    const Point2 c3s = s * coefficient(4 * j + 3), high = s * (square + c3s);
    row[j] = coefficient(4 * j) + s * (one + high);
    row_ds[j] = (one + high) + s * (square + 2 * c3s);
  }
  const Point2 r3t = t * row[3], high = t * (row[2] + r3t);
  dt = (row[1] + high) + t * (row[2] + 2 * r3t);
  ds = row_ds[0] + t * (row_ds[1] + t * (row_ds[2] + t * row_ds[3]));
}

}  // namespace limitsurf
