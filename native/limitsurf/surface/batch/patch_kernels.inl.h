// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of batch evaluation. patch_kernels.cpp includes this file once for each
// instruction set, inside a namespace, after it has included lanes.inl.h and defined kLanes,
// kFewLanes, kFewestLanes, squareRoot(), interleave() and interleavePadded(). Nothing here may call
// a function that is defined elsewhere: its code could be that of another set.

#include "limitsurf/eigen/bspline_formulas.inl.h"
#include "limitsurf/surface/batch/row_places.inl.h"
#include "limitsurf/surface/batch/unit_normal.inl.h"

/// Has compilers take the numbers that are the same for all lanes from memory, each time. Otherwise
/// they put each of them in all lanes and store these before they begin, which takes as long as 8
/// rows.
inline void rereadMemory() {
#if defined(__GNUC__)
  __asm__ volatile("" ::: "memory");
#endif
}

/// What a run does to the derivatives of its patch, as Jet::turn() does.
struct Turned {
  Turned(int turns, double first_scale, double second_scale)
      : swapped(turns % 2 == 1),
        du(kSignOfDu[turns] * first_scale),
        dv(kSignOfDv[turns] * first_scale),
        second(second_scale),
        duv(kSignOfDuv[turns] * second_scale) {}

  bool swapped;
  double du, dv, second, duv;  // factors

 private:
  // The signs by the number of turns. (Branches would be guessed wrong.)
  static constexpr double kSignOfDu[4] = {1, -1, -1, 1}, kSignOfDv[4] = {1, 1, -1, -1},
                          kSignOfDuv[4] = {1, -1, 1, -1};
};

/// Calls body with a function that returns the run's point (x, y).
template <typename Body>
[[gnu::always_inline]] inline void withPoints(const PatchRun& run, const Body& body) {
  if (run.indices) {
    const Lanes<4> anchor = Lanes<4>::load(run.anchor);
    body([&](int x, int y) { return Lanes<4>::load(run.points[run.indices[4 * y + x]]) - anchor; });
  } else {
    body([&](int x, int y) {
      return Lanes<4>::load(
          run.points[run.stride * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)]);
    });
  }
}

/// The place of one number of a net, from the window's first point on.
inline std::size_t netSlot(const PatchRun& run, std::size_t net, std::size_t x, std::size_t y) {
  return net * run.stride * run.stride + run.stride * y + x;
}

/// The control points of a run with as many of their differences as derivatives up to Order need:
/// formed once, and read for each coordinate of many rows.
template <int Order>
class RunLines {
 public:
  explicit RunLines(const PatchRun& run) {
    withPoints(run, [&](const auto& at) {
      for (int i = 0; i < 4; ++i) {
        rows_[i].set(at(0, i), at(1, i), at(2, i), at(3, i));
        if (Order >= 2) {
          columns_[i].set(at(i, 0), at(i, 1), at(i, 2), at(i, 3));
        }
      }
    });
  }

  template <typename Rows>
  [[gnu::always_inline]] void evaluate(int c, const BSplineWeights<Rows>& u,
                                       const BSplineWeights<Rows>& v,
                                       PatchValues<Rows>& patch) const {
    evaluateLines<Order, Rows>([&](int y) { return rows_[y].template at<Rows>(c); },
                               [&](int x) { return columns_[x].template at<Rows>(c); }, u, v,
                               patch);
  }

 private:
  struct Line {
    double point[4][4], first[3][4], second[2][4];  // as WindowLine has them

    using Point = Lanes<4>;
    [[gnu::always_inline]] void set(const Point& p, const Point& q, const Point& r,
                                    const Point& s) {
      p.store(point[0]);
      q.store(point[1]);
      r.store(point[2]);
      s.store(point[3]);
      if (Order >= 1) {
        (q - p).store(first[0]);
        (r - q).store(first[1]);
        (s - r).store(first[2]);
      }
      if (Order >= 2) {
        ((r - q) - (q - p)).store(second[0]);
        ((s - r) - (r - q)).store(second[1]);
      }
    }
    template <typename Rows>
    [[gnu::always_inline]] WindowLine<Rows> at(int c) const {
      WindowLine<Rows> line{};
      for (int i = 0; i < 4; ++i) {
        line.point[i] = Rows::of(point[i][c]);
      }
      for (int i = 0; Order >= 1 && i < 3; ++i) {
        line.first[i] = Rows::of(first[i][c]);
      }
      for (int i = 0; Order >= 2 && i < 2; ++i) {
        line.second[i] = Rows::of(second[i][c]);
      }
      return line;
    }
  };

  alignas(64) Line rows_[4];
  Line columns_[Order >= 2 ? 4 : 1];
};

/// The nets of a run that has them.
template <int Order>
class RunNets {
 public:
  explicit RunNets(const PatchRun& run) : run_(run) {}

  template <typename Rows>
  void evaluate(int c, const BSplineWeights<Rows>& u, const BSplineWeights<Rows>& v,
                PatchValues<Rows>& patch) const {
    evaluateNets<Order, Rows>(
        [&](derivative_nets::Net net, int x, int y) {
          return Rows::of(run_.points[netSlot(run_, net, x, y)][c]);
        },
        u, v, patch);
  }

 private:
  const PatchRun& run_;
};

/// 1 in the lanes for which normalKeepsDigits(), NaN in the others.
template <typename Rows>
[[gnu::always_inline]] inline Rows oneWhereKept(const UnitNormal<Rows>& normal,
                                                const NormalLimits& limits) {
  const Rows nan = Rows::of(__builtin_nan(""));
  Rows keeps = Rows::whereAtLeast(normal.square, Rows::of(kLeastSquare), Rows::of(1), nan);
  keeps = Rows::whereAtLeast(Rows::of(kMostSquare), normal.square, keeps, nan);
  keeps = Rows::whereAtLeast(normal.square, limits.sine_square * normal.lengths, keeps, nan);
  return Rows::whereAtLeast(normal.square, limits.square * normal.squares, keeps, nan);
}

/// The next `count` rows of a run, at most kCount: a lane for each.
template <int Order, int kCount, typename Window, typename Real>
[[gnu::always_inline]] inline void evaluateRows(const PatchRun& run, const Turned& turned,
                                                const Window& window, std::size_t begin, int count,
                                                const PatchResults<Real>& results) {
  using Rows = Lanes<kCount>;
  rereadMemory();
  const RowPlaces<kCount> places(run.rows + begin, count);
  const BSplineWeights<Rows> u(run.scale * Rows::load(run.u + begin) - run.a, run.u_low,
                               run.u_high);
  const BSplineWeights<Rows> v(run.scale * Rows::load(run.v + begin) - run.b, run.v_low,
                               run.v_high);
  Rows position[3], along_u[3], along_v[3], duu[3], duv[3], dvv[3];
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
    PatchValues<Rows> patch;
    window.evaluate(c, u, v, patch);
    position[c] = run.anchor[c] + (run.value_scale * patch.value + run.offset[c]);
    if (Order >= 1) {
      along_u[c] = patch.du * (turned.swapped ? turned.dv : turned.du);
      along_v[c] = patch.dv * (turned.swapped ? turned.du : turned.dv);
    }
    if (Order >= 2) {
      duu[c] = patch.duu * turned.second;
      duv[c] = patch.duv * turned.duv;
      dvv[c] = patch.dvv * turned.second;
    }
  }
  places.put(results.position, position);
  if (Order >= 1) {
    places.put(turned.swapped ? results.dv : results.du, along_u);
    places.put(turned.swapped ? results.du : results.dv, along_v);
    if (results.normal) {
      UnitNormal<Rows> normal(turned.swapped ? along_v : along_u,
                              turned.swapped ? along_u : along_v);
      const Rows keeps = oneWhereKept(normal, run.normal_limits);
      for (Rows& numbers : normal.unit) {
        numbers = numbers * keeps;
      }
      places.put(results.normal, normal.unit);
    }
  }
  if (Order >= 2) {
    places.put(turned.swapped ? results.dvv : results.duu, duu);
    places.put(results.duv, duv);
    places.put(turned.swapped ? results.duu : results.dvv, dvv);
  }
}

/// Weights along one axis, each in all lanes of a point.
struct PointWeights {
  Lanes<4> value[4], first[3], second[2];

  template <typename Weights, typename NumberOf>
  [[gnu::always_inline]] PointWeights(const Weights& weights, const NumberOf& number) {
    for (int i = 0; i < 4; ++i) {
      value[i] = Lanes<4>::of(number(weights.value[i]));
    }
    for (int i = 0; i < 3; ++i) {
      first[i] = Lanes<4>::of(number(weights.first[i]));
    }
    for (int i = 0; i < 2; ++i) {
      second[i] = Lanes<4>::of(number(weights.second[i]));
    }
  }
};

[[gnu::always_inline]] inline void putPoint(double* to, const Lanes<4>& point) {
  storeThree(to, point);
}
inline void putPoint(float* to, const Lanes<4>& point) {
  for (int c = 0; c < 3; ++c) {
    to[c] = static_cast<float>(point.numbers[c]);
  }
}

/// The unit normal, or NaN where it does not meet the limits.
template <typename Real>
inline void putNormal(const Lanes<4>& du, const Lanes<4>& dv, const NormalLimits& limits,
                      Real* to) {
  const double x[3] = {du.numbers[0], du.numbers[1], du.numbers[2]};
  const double y[3] = {dv.numbers[0], dv.numbers[1], dv.numbers[2]};
  const UnitNormal<double> normal(x, y);
  const bool keeps = normalKeepsDigits(normal.square, normal.lengths, normal.squares,
                                       limits.sine_square, limits.square);
  for (int c = 0; c < 3; ++c) {
    to[c] = static_cast<Real>(keeps ? normal.unit[c] : __builtin_nan(""));
  }
}

/// One row, all coordinates at a time.
template <int Order, typename Real>
[[gnu::always_inline]] inline void evaluateRow(const PatchRun& run, const Turned& turned,
                                               const PointWeights& u, const PointWeights& v,
                                               std::size_t row, const PatchResults<Real>& results) {
  using Point = Lanes<4>;
  PatchValues<Point> patch;
  if (run.has_nets) {
    evaluateNets<Order, Point>(
        [&](derivative_nets::Net net, int x, int y) {
          return Point::load(run.points[netSlot(run, net, x, y)]);
        },
        u, v, patch);
  } else {
    withPoints(run, [&](const auto& points) { evaluatePatch<Order, Point>(points, u, v, patch); });
  }
  const std::size_t at = 3 * row;
  putPoint(results.position + at,
           Point::load(run.anchor) + (run.value_scale * patch.value + Point::load(run.offset)));
  if (Order >= 1) {
    const Point du = (turned.swapped ? patch.dv : patch.du) * turned.du;
    const Point dv = (turned.swapped ? patch.du : patch.dv) * turned.dv;
    putPoint(results.du + at, du);
    putPoint(results.dv + at, dv);
    if (results.normal) {
      putNormal(du, dv, run.normal_limits, results.normal + at);
    }
  }
  if (Order >= 2) {
    putPoint(results.duu + at, (turned.swapped ? patch.dvv : patch.duu) * turned.second);
    putPoint(results.duv + at, patch.duv * turned.duv);
    putPoint(results.dvv + at, (turned.swapped ? patch.duu : patch.dvv) * turned.second);
  }
}

/// The rows of a run from `begin` on, of which there are few.
template <int Order, typename Real>
void evaluateOneByOne(const PatchRun& run, const Turned& turned, std::size_t begin,
                      const PatchResults<Real>& results) {
  const bool has_ends = run.u_low || run.u_high || run.v_low || run.v_high;
  for (std::size_t i = begin; i < run.count; ++i) {
    const double u = run.scale * run.u[i] - run.a, v = run.scale * run.v[i] - run.b;
    if (has_ends) {
      const auto number = [](double x) { return x; };
      evaluateRow<Order>(run, turned,
                         PointWeights(BSplineWeights<double>(u, run.u_low, run.u_high), number),
                         PointWeights(BSplineWeights<double>(v, run.v_low, run.v_high), number),
                         run.rows[i], results);
    } else {
      using Pair = Lanes<2>;
      const BSplineWeights<Pair> both(Pair{{u, v}}, false, false);
      evaluateRow<Order>(
          run, turned, PointWeights(both, [](const Pair& x) { return x.numbers[0]; }),
          PointWeights(both, [](const Pair& x) { return x.numbers[1]; }), run.rows[i], results);
    }
  }
}

/// As many lanes at a time as pay.
template <int Order, typename Window, typename Real>
void evaluateInLanes(const PatchRun& run, const Turned& turned, const PatchResults<Real>& results) {
  const Window window(run);
  std::size_t begin = 0;
  for (; begin + kLanes <= run.count; begin += kLanes) {
    evaluateRows<Order, kLanes>(run, turned, window, begin, kLanes, results);
  }
  const int left = static_cast<int>(run.count - begin);
  if (left > kFewLanes + 1) {
    evaluateRows<Order, kLanes>(run, turned, window, begin, left, results);
    return;
  }
  if (left > 1) {
    const int some = left < kFewLanes ? left : kFewLanes;
    evaluateRows<Order, kFewLanes>(run, turned, window, begin, some, results);
    begin += static_cast<std::size_t>(some);
  }
  evaluateOneByOne<Order>(run, turned, begin, results);
}

template <int Order, typename Real>
void evaluate(const PatchRun& run, const PatchResults<Real>& results) {
  const Turned turned(run.turns, run.first_scale, run.second_scale);
  if (run.count < kFewestLanes) {
    evaluateOneByOne<Order>(run, turned, 0, results);
  } else if (run.has_nets) {
    evaluateInLanes<Order, RunNets<Order>>(run, turned, results);
  } else {
    evaluateInLanes<Order, RunLines<Order>>(run, turned, results);
  }
}

#include "limitsurf/surface/batch/row_kernels.inl.h"
#include "limitsurf/surface/batch/weighted_kernels.inl.h"

template <typename Real>
inline constexpr PatchKernelsOf<Real> kKernelsOf = {
    {evaluate<0, Real>, evaluate<1, Real>, evaluate<2, Real>},
    {evaluateOnGrids<0, Real>, evaluateOnGrids<1, Real>, evaluateOnGrids<2, Real>},
    {evaluateSingles<0, Real>, evaluateSingles<1, Real>, evaluateSingles<2, Real>},
    {evaluateWeighted<0, Real>, evaluateWeighted<1, Real>},
};
inline const PatchKernels kKernels = {kKernelsOf<double>, kKernelsOf<float>};
