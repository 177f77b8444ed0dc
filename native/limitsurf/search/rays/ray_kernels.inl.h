// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of searches along rays. ray_kernels.cpp compiles this file once for each
// instruction set, inside a namespace. Nothing here may call a function that is defined elsewhere:
// its code could be that of another set.

#include "limitsurf/surface/batch/lanes.inl.h"

using Four = Lanes<4>;

inline void see(const double points[16][4], const double axes[3][4], const double offset[3],
                double x[16], double y[16], double z[16]) {
  for (int i = 0; i < 16; i += 4) {
    Four coordinates[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double of_points[4] = {points[i][axis], points[i + 1][axis], points[i + 2][axis],
                                   points[i + 3][axis]};
      coordinates[axis] = Four::load(of_points);
    }
    const auto along = [&](int axis) {
      return offset[axis] + (coordinates[0] * axes[axis][0] + coordinates[1] * axes[axis][1] +
                             coordinates[2] * axes[axis][2]);
    };
    along(0).store(x + i);
    along(1).store(y + i);
    along(2).store(z + i);
  }
}

inline double leastOf(const Four& a) {
  double n[4];
  a.store(n);
  const double b = n[0] < n[1] ? n[0] : n[1], c = n[2] < n[3] ? n[2] : n[3];
  return b < c ? b : c;
}

inline double largestOf(const Four& a) {
  double n[4];
  a.store(n);
  const double b = n[0] > n[1] ? n[0] : n[1], c = n[2] > n[3] ? n[2] : n[3];
  return b > c ? b : c;
}

/// The least and the largest of sixteen numbers.
struct Range {
  explicit Range(const Four a[4])
      : least(leastOf(Four::smaller(Four::smaller(a[0], a[1]), Four::smaller(a[2], a[3])))),
        largest(largestOf(Four::larger(Four::larger(a[0], a[1]), Four::larger(a[2], a[3])))) {}

  bool isOutside(double margin) const { return least > margin || largest < -margin; }
  bool isWithin(double margin) const { return least >= -margin && largest <= margin; }

  double least, largest;
};

inline Four magnitudes(const Four& a) { return Four::larger(a, Four::of(0) - a); }

/// Whether the ray sees no two points at the same place: the derivatives of the preconditioned
/// coordinates a and b form a matrix that is diagonally dominant everywhere.
inline bool isInjective(const Four a[4], const Four b[4]) {
  constexpr double kNone = __builtin_inf();
  // Three numbers of a row have a next one; the fourth difference does not count.
  constexpr double kIgnored[4] = {0, 0, 0, kNone}, kCounted[4] = {1, 1, 1, 0};
  double rows_a[17], rows_b[17];
  for (int j = 0; j < 4; ++j) {
    a[j].store(rows_a + 4 * j);
    b[j].store(rows_b + 4 * j);
  }
  rows_a[16] = rows_b[16] = 0;
  Four as = Four::of(kNone), bs = Four::of(0);
  for (int j = 0; j < 4; ++j) {
    as = Four::smaller(as, (Four::load(rows_a + 4 * j + 1) - a[j]) + Four::load(kIgnored));
    bs = Four::larger(bs,
                      magnitudes((Four::load(rows_b + 4 * j + 1) - b[j]) * Four::load(kCounted)));
  }
  Four bt = Four::of(kNone), at = Four::of(0);
  for (int j = 0; j < 3; ++j) {
    bt = Four::smaller(bt, b[j + 1] - b[j]);
    at = Four::larger(at, magnitudes(a[j + 1] - a[j]));
  }
  const double least_as = leastOf(as), least_bt = leastOf(bt);
  return least_as > 0 && least_bt > 0 && least_as * least_bt > largestOf(at) * largestOf(bs);
}

inline RayMeeting meet(const double x[16], const double y[16], const double z[16],
                       const RayLimits& limits) {
  // The mean derivatives of the part, from the differences of its corners, count as linearly
  // dependent if the sine of their angle is at most the square root of this.
  constexpr double kSingular = 1e-18;
  Four rows_x[4], rows_y[4], rows_z[4];
  for (int j = 0; j < 4; ++j) {
    rows_x[j] = Four::load(x + 4 * j);
    rows_y[j] = Four::load(y + 4 * j);
    rows_z[j] = Four::load(z + 4 * j);
  }
  const Range of_x(rows_x), of_y(rows_y), of_z(rows_z);
  if (of_x.isOutside(limits.margin) || of_y.isOutside(limits.margin) || of_z.least > limits.to ||
      of_z.largest < limits.from) {
    return RayMeeting::none;
  }
  if (of_x.isWithin(limits.tolerance) && of_y.isWithin(limits.tolerance)) {
    return RayMeeting::everywhere;
  }
  const double xs = ((x[3] - x[0]) + (x[15] - x[12])) / 2,
               xt = ((x[12] - x[0]) + (x[15] - x[3])) / 2;
  const double ys = ((y[3] - y[0]) + (y[15] - y[12])) / 2,
               yt = ((y[12] - y[0]) + (y[15] - y[3])) / 2;
  const double determinant = xs * yt - xt * ys;
  if (!(determinant * determinant > kSingular * ((xs * xs + ys * ys) * (xt * xt + yt * yt)))) {
    return RayMeeting::unknown;
  }
  // With the inverse of these derivatives as preconditioner the coordinates are nearly s - s0 and
  // t - t0, with the hit at (s0, t0).
  const double inverse = 1 / determinant;
  Four a[4], b[4];
  for (int j = 0; j < 4; ++j) {
    a[j] = (yt * rows_x[j] - xt * rows_y[j]) * inverse;
    b[j] = (xs * rows_y[j] - ys * rows_x[j]) * inverse;
  }
  const auto magnitude = [](double number) { return number < 0 ? -number : number; };
  const double margin = limits.margin * magnitude(inverse);
  if (Range(a).isOutside(margin * (magnitude(yt) + magnitude(xt))) ||
      Range(b).isOutside(margin * (magnitude(ys) + magnitude(xs)))) {
    return RayMeeting::none;
  }
  return isInjective(a, b) ? RayMeeting::once_at_most : RayMeeting::unknown;
}

/// A bicubic's value and derivatives.
struct Bicubic {
  /// The weights of value and derivative: the cubic Bernstein polynomials, and the quadratic ones
  /// times 3.
  struct Weights {
    explicit Weights(double t)
        : value{(1 - t) * (1 - t) * (1 - t), 3 * (1 - t) * (1 - t) * t, 3 * (1 - t) * t * t,
                t * t * t},
          first{3 * (1 - t) * (1 - t), 6 * (1 - t) * t, 3 * t * t} {}
    double value[4], first[3];
  };

  Bicubic(const double f[16], const Weights& by_s, const Weights& by_t) {
    const Four f0 = Four::load(f), f1 = Four::load(f + 4), f2 = Four::load(f + 8),
               f3 = Four::load(f + 12);
    const double *vt = by_t.value, *dt = by_t.first, *ds = by_s.first;
    const Four rows = vt[0] * f0 + vt[1] * f1 + vt[2] * f2 + vt[3] * f3;
    const Four slopes = dt[0] * (f1 - f0) + dt[1] * (f2 - f1) + dt[2] * (f3 - f2);
    const Four vs = Four::load(by_s.value);
    double row[4];
    rows.store(row);
    value = sum(vs * rows);
    t = sum(vs * slopes);
    s = ds[0] * (row[1] - row[0]) + ds[1] * (row[2] - row[1]) + ds[2] * (row[3] - row[2]);
  }

  static double sum(const Four& a) {
    double n[4];
    a.store(n);
    return (n[0] + n[1]) + (n[2] + n[3]);
  }

  double value, s, t;
};

inline void offset(const double x[16], const double y[16], double s, double t, OffsetFromRay& out) {
  const Bicubic::Weights by_s(s), by_t(t);
  const Bicubic of_x(x, by_s, by_t), of_y(y, by_s, by_t);
  out = {of_x.value, of_y.value, of_x.s, of_y.s, of_x.t, of_y.t};
}

inline void place(const double z[16], double s, double t, PlaceAlongRay& out) {
  const Bicubic of_z(z, Bicubic::Weights(s), Bicubic::Weights(t));
  out = {of_z.value, of_z.s, of_z.t};
}

constexpr RayKernels kKernels = {see, meet, offset, place};
