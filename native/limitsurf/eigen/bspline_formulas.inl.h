// SPDX-License-Identifier: Apache-2.0
//
// The arithmetic of a bicubic B-spline patch, for numbers of any type. To be included inside a
// namespace, and so as often as code is compiled for different instruction sets (see
// patch_kernels.h): all of them do the same operations in the same order, and round alike.

/// Weights of four uniform cubic B-spline control points at t in [0, 1].
///
/// Derivatives are formed from the points' first and second differences, so that equal points give
/// a derivative of exactly 0 and equally spaced ones a second derivative of exactly 0. Near an
/// extraordinary vertex derivatives are multiplied by 2^n and 4^n, and their rounding is as well.
///
/// At a boundary the missing first (low) or last (high) point is the linear continuation of the two
/// next to it (Lacewell & Burley 2007, figure 2: p0 = 2 p1 - p2), so that the missing difference
/// equals its neighbour. The weights contain this; the missing point itself has weight 0.
template <typename Number>
struct BSplineWeights {
  Number value[4];
  Number first[3];   ///< on the differences p1 - p0, p2 - p1, p3 - p2
  Number second[2];  ///< on the differences of those

  [[gnu::always_inline]] BSplineWeights(const Number& t, bool low, bool high) {
    const Number zero{}, s = 1 - t;
    const double sixth = 1. / 6;
    first[0] = low ? zero : 0.5 * (s * s);
    first[2] = high ? zero : 0.5 * (t * t);
    first[1] = 1 - first[0] - first[2];
    second[0] = low ? zero : s;
    second[1] = high ? zero : t;
    const Number s3 = low ? zero : s * s * s * sixth, t3 = high ? zero : t * t * t * sixth;
    // The line through p1 and p2 plus a multiple of the second difference on either side of it.
    value[0] = s3;
    value[1] = s - 2 * s3 + t3;
    value[2] = t - 2 * t3 + s3;
    value[3] = t3;
  }

  /// The same derivatives as weights on the points.
  void firstOnPoints(Number out[4]) const {
    out[0] = -first[0];
    out[1] = first[0] - first[1];
    out[2] = first[1] - first[2];
    out[3] = first[2];
  }
};

/// Position and derivatives of a bicubic patch: value; du, dv; duu, duv, dvv.
template <typename Point>
struct PatchValues {
  Point value, du, dv, duu, duv, dvv;
};

/// Four control points in a row of a window, and their differences.
template <typename Point>
struct WindowLine {
  Point point[4];
  Point first[3];   ///< p1 - p0, p2 - p1, p3 - p2
  Point second[2];  ///< the differences of those

  static WindowLine of(const Point& p, const Point& q, const Point& r, const Point& s) {
    WindowLine line{{p, q, r, s}, {q - p, r - q, s - r}, {}};
    line.second[0] = line.first[1] - line.first[0];
    line.second[1] = line.first[2] - line.first[1];
    return line;
  }
};

/// The bicubic patch of a 4 x 4 window of control points; derivatives up to Order. `row(y)` is the
/// WindowLine of the points (0, y) to (3, y). `column(x)` is that of (x, 0) to (x, 3), of which
/// only the second differences are used, and only for second derivatives.
template <int Order, typename Point, typename Weights, typename Row, typename Column>
[[gnu::always_inline]] inline void evaluateLines(const Row& row_of, const Column& column_of,
                                                 const Weights& u, const Weights& v,
                                                 PatchValues<Point>& out) {
  const auto value = [](const Weights& w, const Point& a, const Point& b, const Point& c,
                        const Point& d) -> Point {
    return w.value[0] * a + w.value[1] * b + w.value[2] * c + w.value[3] * d;
  };
  Point row[4], row_du[4], row_duu[4];
  if (Order >= 2) {
    // dvv is formed from the points themselves: the sums over rows, which have been rounded, are
    // no longer equally spaced exactly where the points are.
    Point column[4];
    for (int x = 0; x < 4; ++x) {
      const WindowLine<Point> line = column_of(x);
      column[x] = v.second[0] * line.second[0] + v.second[1] * line.second[1];
    }
    out.dvv = value(u, column[0], column[1], column[2], column[3]);
  }
  for (int y = 0; y < 4; ++y) {
    const WindowLine<Point> line = row_of(y);
    row[y] = value(u, line.point[0], line.point[1], line.point[2], line.point[3]);
    if (Order >= 1) {
      row_du[y] =
          u.first[0] * line.first[0] + u.first[1] * line.first[1] + u.first[2] * line.first[2];
    }
    if (Order >= 2) {
      row_duu[y] = u.second[0] * line.second[0] + u.second[1] * line.second[1];
    }
  }
  out.value = value(v, row[0], row[1], row[2], row[3]);
  if (Order >= 1) {
    out.du = value(v, row_du[0], row_du[1], row_du[2], row_du[3]);
    out.dv = v.first[0] * (row[1] - row[0]) + v.first[1] * (row[2] - row[1]) +
             v.first[2] * (row[3] - row[2]);
    if (Order >= 2) {
      out.duu = value(v, row_duu[0], row_duu[1], row_duu[2], row_duu[3]);
      out.duv = v.first[0] * (row_du[1] - row_du[0]) + v.first[1] * (row_du[2] - row_du[1]) +
                v.first[2] * (row_du[3] - row_du[2]);
    }
  }
}

/// The same. `points(x, y)`, 0 <= x, y <= 3, returns one of the control points.
template <int Order, typename Point, typename Weights, typename Points>
inline void evaluatePatch(const Points& points, const Weights& u, const Weights& v,
                          PatchValues<Point>& out) {
  const auto row = [&](int y) {
    return WindowLine<Point>::of(points(0, y), points(1, y), points(2, y), points(3, y));
  };
  const auto column = [&](int x) {
    return WindowLine<Point>::of(points(x, 0), points(x, 1), points(x, 2), points(x, 3));
  };
  evaluateLines<Order, Point>(row, column, u, v, out);
}

/// The same from the differences of the points, which are given (derivative_nets.h): du(x, y) is
/// that of the points (x + 1, y) and (x, y), and so on.
template <int Order, typename Point, typename Weights, typename Nets>
inline void evaluateNets(const Nets& nets, const Weights& u, const Weights& v,
                         PatchValues<Point>& out) {
  using namespace derivative_nets;
  const auto cubic = [](const Weights& w, const auto& p) -> Point {
    return w.value[0] * p(0) + w.value[1] * p(1) + w.value[2] * p(2) + w.value[3] * p(3);
  };
  const auto quadratic = [](const Weights& w, const auto& p) -> Point {
    return w.first[0] * p(0) + w.first[1] * p(1) + w.first[2] * p(2);
  };
  const auto linear = [](const Weights& w, const auto& p) -> Point {
    return w.second[0] * p(0) + w.second[1] * p(1);
  };
  const auto sum = [&](Net net, const auto& along_u, const auto& along_v) -> Point {
    return along_v(v, [&](int y) -> Point {
      return along_u(u, [&](int x) -> Point { return nets(net, x, y); });
    });
  };
  out.value = sum(kPoints, cubic, cubic);
  if (Order >= 1) {
    out.du = sum(kDu, quadratic, cubic);
    out.dv = sum(kDv, cubic, quadratic);
  }
  if (Order >= 2) {
    out.duu = sum(kDuu, linear, cubic);
    out.duv = sum(kDuv, quadratic, quadratic);
    out.dvv = sum(kDvv, cubic, linear);
  }
}
