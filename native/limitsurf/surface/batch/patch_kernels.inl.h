// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of batch evaluation. patch_kernels.cpp includes this file once for each
// instruction set, inside a namespace, after it has defined kLanes, kFewestLanes, squareRoot(),
// interleave() and interleavePadded(). Nothing here may call a function that is defined elsewhere:
// its code could be that of another set.

#include "limitsurf/eigen/bspline_formulas.inl.h"
#include "limitsurf/surface/batch/lanes.inl.h"
#include "limitsurf/surface/batch/unit_normal.inl.h"

inline void gather(const double (*points)[4], const int indices[16], double window[16][4]) {
  using Point = Lanes<4>;
  const Point anchor = Point::load(points[indices[5]]);
  for (int i = 0; i < 16; ++i) {
    (Point::load(points[indices[i]]) - anchor).store(window[i]);
  }
}

/// kLanes rows at a time.
using Rows = Lanes<kLanes>;

/// Where the results of up to kLanes rows go.
struct RowPlaces {
  RowPlaces(const std::size_t* rows_, int count_)
      : rows(rows_),
        count(count_),
        contiguous(count_ == kLanes && rows_[kLanes - 1] - rows_[0] == kLanes - 1) {}

  template <typename Real>
  void put(Real* to, const Rows vectors[3]) const {
    if (contiguous) {
      Rows interleaved[3];
      interleave(vectors, interleaved);
      for (int i = 0; i < 3; ++i) {
        interleaved[i].store(to + 3 * rows[0] + i * kLanes);
      }
      return;
    }
    // With a fourth number in each row, no row is read from memory that two instructions have
    // written: processors do not read such a row until both have reached the cache.
    Rows padded[4];
    interleavePadded(vectors, padded);
    Real numbers[4 * kLanes];
    for (int i = 0; i < 4; ++i) {
      padded[i].store(numbers + i * kLanes);
    }
    for (int lane = 0; lane < count; ++lane) {
      __builtin_memcpy(to + 3 * rows[lane], numbers + 4 * lane, 3 * sizeof(Real));
    }
  }

  const std::size_t* rows;
  int count;
  bool contiguous;  ///< whether there are kLanes rows that follow each other
};

/// What a run does to the derivatives of its patch, as Jet::turn() does.
struct Turned {
  explicit Turned(const PatchRun& run)
      : swapped(run.turns % 2 == 1),
        du(run.turns == 1 || run.turns == 2 ? -run.first_scale : run.first_scale),
        dv(run.turns == 2 || run.turns == 3 ? -run.first_scale : run.first_scale),
        second(run.second_scale),
        duv(swapped ? -run.second_scale : run.second_scale) {}

  bool swapped;
  double du, dv, second, duv;  // factors
};

/// The place of one number of a net, from the window's first point on.
inline int netSlot(const PatchRun& run, int net, int x, int y) {
  return net * run.stride * run.stride + run.stride * y + x;
}

template <int Order, typename Real>
inline void evaluateRows(const PatchRun& run, const Turned& turned, std::size_t begin, int count,
                         const PatchResults<Real>& results) {
  const RowPlaces places(run.rows + begin, count);
  Rows u, v;
  if (count == kLanes) {
    u = Rows::load(run.u + begin);
    v = Rows::load(run.v + begin);
  } else {
    double some_u[kLanes] = {}, some_v[kLanes] = {};
    for (int lane = 0; lane < count; ++lane) {
      some_u[lane] = run.u[begin + lane];
      some_v[lane] = run.v[begin + lane];
    }
    u = Rows::load(some_u);
    v = Rows::load(some_v);
  }
  const BSplineWeights<Rows> u_weights(u, run.u_low, run.u_high);
  const BSplineWeights<Rows> v_weights(v, run.v_low, run.v_high);
  Rows position[3], du[3], dv[3], duu[3], duv[3], dvv[3];
  for (int c = 0; c < 3; ++c) {
    PatchValues<Rows> patch;
    if (run.has_nets) {
      evaluateNets<Order, Rows>(
          [&](derivative_nets::Net net, int x, int y) {
            return Rows::of(run.points[netSlot(run, net, x, y)][c]);
          },
          u_weights, v_weights, patch);
    } else {
      evaluatePatch<Order, Rows>(
          [&](int x, int y) { return Rows::of(run.points[run.stride * y + x][c]); }, u_weights,
          v_weights, patch);
    }
    position[c] = run.anchor[c] + (run.value_scale * patch.value + run.offset[c]);
    if (Order >= 1) {
      du[c] = (turned.swapped ? patch.dv : patch.du) * turned.du;
      dv[c] = (turned.swapped ? patch.du : patch.dv) * turned.dv;
    }
    if (Order >= 2) {
      duu[c] = (turned.swapped ? patch.dvv : patch.duu) * turned.second;
      duv[c] = patch.duv * turned.duv;
      dvv[c] = (turned.swapped ? patch.duu : patch.dvv) * turned.second;
    }
  }
  places.put(results.position, position);
  if (Order >= 1) {
    places.put(results.du, du);
    places.put(results.dv, dv);
    if (results.normal) {
      UnitNormal<Rows> normal(du, dv);
      double square[kLanes], lengths[kLanes], squares[kLanes];
      normal.square.store(square);
      normal.lengths.store(lengths);
      normal.squares.store(squares);
      for (int lane = 0; lane < count; ++lane) {
        if (!normalKeepsDigits(square[lane], lengths[lane], squares[lane],
                               run.normal_limits.sine_square, run.normal_limits.square)) {
          for (Rows& numbers : normal.unit) {
            numbers.numbers[lane] = __builtin_nan("");
          }
        }
      }
      places.put(results.normal, normal.unit);
    }
  }
  if (Order >= 2) {
    places.put(results.duu, duu);
    places.put(results.duv, duv);
    places.put(results.dvv, dvv);
  }
}

/// One row, all coordinates at a time.
template <int Order, typename Real>
inline void evaluateRow(const PatchRun& run, const Turned& turned, std::size_t i,
                        const PatchResults<Real>& results) {
  using Point = Lanes<4>;
  const BSplineWeights<double> u(run.u[i], run.u_low, run.u_high);
  const BSplineWeights<double> v(run.v[i], run.v_low, run.v_high);
  PatchValues<Point> patch;
  if (run.has_nets) {
    evaluateNets<Order, Point>(
        [&](derivative_nets::Net net, int x, int y) {
          return Point::load(run.points[netSlot(run, net, x, y)]);
        },
        u, v, patch);
  } else {
    evaluatePatch<Order, Point>(
        [&](int x, int y) { return Point::load(run.points[run.stride * y + x]); }, u, v, patch);
  }
  const std::size_t at = 3 * run.rows[i];
  const auto putPoint = [at](Real* to, const Point& point) {
    for (int c = 0; c < 3; ++c) {
      to[at + c] = static_cast<Real>(point.numbers[c]);
    }
  };
  for (int c = 0; c < 3; ++c) {
    results.position[at + c] = static_cast<Real>(
        run.anchor[c] + (run.value_scale * patch.value.numbers[c] + run.offset[c]));
  }
  if (Order >= 1) {
    const Point du = (turned.swapped ? patch.dv : patch.du) * turned.du;
    const Point dv = (turned.swapped ? patch.du : patch.dv) * turned.dv;
    putPoint(results.du, du);
    putPoint(results.dv, dv);
    if (results.normal) {
      const double x[3] = {du.numbers[0], du.numbers[1], du.numbers[2]};
      const double y[3] = {dv.numbers[0], dv.numbers[1], dv.numbers[2]};
      const UnitNormal<double> normal(x, y);
      const bool keeps = normalKeepsDigits(normal.square, normal.lengths, normal.squares,
                                           run.normal_limits.sine_square, run.normal_limits.square);
      for (int c = 0; c < 3; ++c) {
        results.normal[at + c] = static_cast<Real>(keeps ? normal.unit[c] : __builtin_nan(""));
      }
    }
  }
  if (Order >= 2) {
    putPoint(results.duu, (turned.swapped ? patch.dvv : patch.duu) * turned.second);
    putPoint(results.duv, patch.duv * turned.duv);
    putPoint(results.dvv, (turned.swapped ? patch.duu : patch.dvv) * turned.second);
  }
}

template <int Order, typename Real>
void evaluate(const PatchRun& run, const PatchResults<Real>& results) {
  const Turned turned(run);
  if (run.count < kFewestLanes) {
    for (std::size_t i = 0; i < run.count; ++i) {
      evaluateRow<Order>(run, turned, i, results);
    }
    return;
  }
  for (std::size_t begin = 0; begin < run.count; begin += kLanes) {
    const int count = run.count - begin < kLanes ? static_cast<int>(run.count - begin) : kLanes;
    evaluateRows<Order>(run, turned, begin, count, results);
  }
}

inline const PatchKernels kKernels = {
    gather,
    {evaluate<0, double>, evaluate<1, double>, evaluate<2, double>},
    {evaluate<0, float>, evaluate<1, float>, evaluate<2, float>},
};
