// SPDX-License-Identifier: Apache-2.0
//
// Newton's iteration for one point of several rows at once. kernels_by_set.inl.h compiles this file
// for each instruction set. Nothing here may call a function that is defined elsewhere: its code
// could be that of another set.

#include "limitsurf/surface/batch/lanes.inl.h"

/// A number of each row.
using Rows = Lanes<kLanes>;

/// A point of the plane for each row.
struct RowPoints {
  Rows x, y;

  static RowPoints load(const double (&from)[2][InverseRows::kCount], int first) {
    return {Rows::load(from[0] + first), Rows::load(from[1] + first)};
  }
  void store(double (&to)[2][InverseRows::kCount], int first) const {
    x.store(to[0] + first);
    y.store(to[1] + first);
  }

  [[gnu::always_inline]] friend RowPoints operator+(const RowPoints& a, const RowPoints& b) {
    return {a.x + b.x, a.y + b.y};
  }
  [[gnu::always_inline]] friend RowPoints operator-(const RowPoints& a, const RowPoints& b) {
    return {a.x - b.x, a.y - b.y};
  }
  [[gnu::always_inline]] friend RowPoints operator*(const Rows& a, const RowPoints& b) {
    return {a * b.x, a * b.y};
  }
};

inline Rows crossOf(const RowPoints& a, const RowPoints& b) { return a.x * b.y - a.y * b.x; }
inline Rows sizeOf(const Rows& a) { return Rows::larger(a, Rows::of(0) - a); }

/// a where a point is settled (1), b elsewhere (0).
inline Rows chosen(const Rows& settled, const Rows& a, const Rows& b) {
  return Rows::whereAtLeast(settled, Rows::of(1), a, b);
}
inline RowPoints chosen(const Rows& settled, const RowPoints& a, const RowPoints& b) {
  return {chosen(settled, a.x, b.x), chosen(settled, a.y, b.y)};
}

inline bool allSettled(const Rows& settled) {
  double numbers[kLanes], least = 1;
  settled.store(numbers);
  for (const double number : numbers) {
    least = number < least ? number : least;
  }
  return least > 0;
}

/// The values of the map for one point of each row.
class RowCell {
 public:
  explicit RowCell(const CellNumbers& cell) : cell_(cell) {}

  RowPoints at(int i) const {
    return {Rows::of(cell_.coefficients[0][i]), Rows::of(cell_.coefficients[1][i])};
  }

  /// What the value at (s, t) leaves of the target, and the derivatives.
  [[gnu::always_inline]] void evaluate(const RowPoints& place, const RowPoints& target,
                                       RowPoints& rest, RowPoints& ds, RowPoints& dt) const {
    const Rows s = place.x, t = place.y, two = Rows::of(2);
    RowPoints row[4], row_ds[4];
    for (int j = 0; j < 4; ++j) {
      const RowPoints one = at(4 * j + 1), square = at(4 * j + 2), c3s = s * at(4 * j + 3);
      const RowPoints high = s * (square + c3s);
      row[j] = s * (one + high);
      row_ds[j] = (one + high) + s * (square + two * c3s);
    }
    // The constant terms are added last, since what they leave of the target is small.
    for (int j = 1; j < 4; ++j) {
      row[j] = row[j] + at(4 * j);
    }
    const RowPoints r3t = t * row[3], high = t * (row[2] + r3t);
    rest = (target - at(0)) - (row[0] + t * (row[1] + high));
    dt = (row[1] + high) + t * (row[2] + two * r3t);
    ds = row_ds[0] + t * (row_ds[1] + t * (row_ds[2] + t * row_ds[3]));
  }

  RowPoints guess(const RowPoints& target) const {
    const RowPoints r = target - at(0);
    return {r.x * cell_.m_s[0] + r.y * cell_.m_t[0], r.x * cell_.m_s[1] + r.y * cell_.m_t[1]};
  }

 private:
  const CellNumbers& cell_;
};

/// A place in the cell for each row, as CellInverse describes it.
struct RowPlaces {
  RowPoints x, ds, dt, beyond;
  Rows determinant, found;
};

inline RowPoints within(const RowPoints& a) {
  const Rows low = Rows::of(-0.5), high = Rows::of(0.5);
  return {Rows::smaller(Rows::larger(a.x, low), high), Rows::smaller(Rows::larger(a.y, low), high)};
}

/// Newton's iteration from out.x, for the rows that are not settled.
[[gnu::always_inline]] inline void findPlaces(const CellNumbers& cell, const RowPoints& target,
                                              Rows settled, RowPlaces& out) {
  constexpr int kMostSteps = 32;  // see CellInverse
  const RowCell map(cell);
  const Rows zero = Rows::of(0), one = Rows::of(1), doubtful = Rows::of(0.5);
  out.x = within(out.x);
  out.found = doubtful;
  for (int step = 0; step < kMostSteps && !allSettled(settled); ++step) {
    RowPoints rest, ds, dt;
    map.evaluate(out.x, target, rest, ds, dt);
    const Rows determinant = crossOf(ds, dt);
    const RowPoints move = {crossOf(rest, dt) / determinant, crossOf(ds, rest) / determinant};
    const RowPoints beyond = out.x + move, next = within(beyond), outside = beyond - next;
    out.ds = chosen(settled, out.ds, ds);
    out.dt = chosen(settled, out.dt, dt);
    out.determinant = chosen(settled, out.determinant, determinant);
    out.beyond = chosen(settled, out.beyond, beyond);
    out.x = chosen(settled, out.x, next);
    const Rows length = Rows::larger(sizeOf(move.x), sizeOf(move.y));
    const RowPoints off = outside.x * ds + outside.y * dt;
    const Rows has_it = Rows::whereAtLeast(Rows::of(cell.tolerance[0]), sizeOf(off.x), one, zero) *
                        Rows::whereAtLeast(Rows::of(cell.tolerance[1]), sizeOf(off.y), one, zero);
    const Rows is_close = Rows::whereAtLeast(one, cell.curvature * length * length, one, zero);
    const Rows far = Rows::larger(sizeOf(outside.x), sizeOf(outside.y));
    const Rows is_lost =
        Rows::whereAtLeast(cell.contraction * length + Rows::of(cell.reach), far, zero, one);
    // Steps this short do not tell any more on which side of the border the place is.
    const Rows is_short = Rows::whereAtLeast(Rows::of(2 * cell.reach), length, one, zero) *
                          Rows::whereAtLeast(zero, far, zero, one);
    const Rows found = Rows::larger(is_close * has_it, doubtful * (one - is_lost));
    out.found = chosen(settled, out.found, found);
    settled = Rows::larger(settled, Rows::larger(Rows::larger(is_close, is_lost), is_short));
  }
}

inline void findBlock(const CellNumbers& cell, InverseRows& rows, int begin, int end) {
  const RowCell map(cell);
  const Rows zero = Rows::of(0), one = Rows::of(1);
  for (int first = 0; first < rows.count; first += kLanes) {
    RowPoints last = RowPoints::load(rows.last, first), step = RowPoints::load(rows.step, first);
    RowPoints before = RowPoints::load(rows.before, first);
    const Rows x0 = Rows::load(rows.x0 + first), y = Rows::load(rows.y + first);
    const Rows length = Rows::load(rows.length + first);
    for (int point = begin; point < end; ++point) {
      const RowPoints target = {x0 + static_cast<double>(point), y};
      RowPlaces place;
      // The start is extrapolated, quadratically as soon as three points are known.
      place.x = point == 0  ? map.guess(target)
                : point > 2 ? last + (Rows::of(2) * step - before)
                            : last + step;
      place.ds = place.dt = place.beyond = place.x;
      place.determinant = one;
      const Rows is_beyond = Rows::whereAtLeast(Rows::of(point), length, one, zero);
      findPlaces(cell, target, is_beyond, place);
      if (point == 0) {
        step = {place.dt.y / place.determinant, (zero - place.ds.y) / place.determinant};
      } else {
        before = step;
        step = place.beyond - last;
      }
      last = place.beyond;
      place.x.x.store(rows.s[point - begin] + first);
      place.x.y.store(rows.t[point - begin] + first);
      place.determinant.store(rows.determinant[point - begin] + first);
      place.found.store(rows.found[point - begin] + first);
    }
    last.store(rows.last, first);
    step.store(rows.step, first);
    before.store(rows.before, first);
  }
}

constexpr RowInverse kKernels = {findBlock};
