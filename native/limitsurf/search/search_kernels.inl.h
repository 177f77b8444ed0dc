// SPDX-License-Identifier: Apache-2.0
//
// The inner loops of searches. search_kernels.cpp compiles this file once for each instruction set,
// inside a namespace. Nothing here may call a function that is defined elsewhere: its code could be
// that of another set.

#include "limitsurf/surface/batch/lanes.inl.h"

using Four = Lanes<4>;

inline double move(const double points[16][4], const double offset[4], const double away[4],
                   double out[16][4]) {
  const Four by = Four::load(offset), to = Four::load(away);
  Four low = Four::of(__builtin_inf()), high = Four::of(-__builtin_inf());
  for (int i = 0; i < 16; ++i) {
    const Four point = Four::load(points[i]) + by;
    point.store(out[i]);
    low = Four::smaller(low, point);
    high = Four::larger(high, point);
  }
  const Four nearest = Four::smaller(Four::larger(to, low), high);
  double squared[4];
  (nearest * (nearest - 2 * to)).store(squared);
  return squared[0] + squared[1] + squared[2];  // the fourth numbers are padding
}

inline void squaredDistance(const double points[16][4], const double away[4],
                            double out[kDistanceSize]) {
  constexpr double kBinomial3[4] = {1, 3, 3, 1};
  // 1 / binomials of 6, and the padding
  constexpr double kInverse6[8] = {1, 1. / 6, 1. / 15, 1. / 20, 1. / 15, 1. / 6, 1, 1};
  const Four binomials = Four::load(kBinomial3);
  // With the binomials multiplied in, the product of two polynomials is a convolution. Rows by
  // coordinates, and once more as single numbers.
  Four rows[3][4];
  double single[3][16];
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < 4; ++j) {
      const double row[4] = {points[4 * j][axis], points[4 * j + 1][axis], points[4 * j + 2][axis],
                             points[4 * j + 3][axis]};
      rows[axis][j] = Four::load(row) * binomials * kBinomial3[j];
      rows[axis][j].store(single[axis] + 4 * j);
    }
  }
  const bool is_far = away[0] != 0 || away[1] != 0 || away[2] != 0;
  for (int r = 0; r < 7; ++r) {
    Four shifted[4] = {Four::of(0), Four::of(0), Four::of(0), Four::of(0)};
    for (int a = r < 4 ? 0 : r - 3; 2 * a <= r; ++a) {
      const int b = r - a;
      const double factor = a == b ? 1 : 2;
      for (int axis = 0; axis < 3; ++axis) {
        const Four row = factor * rows[axis][b];
        for (int i = 0; i < 4; ++i) {
          shifted[i] = shifted[i] + single[axis][4 * a + i] * row;
        }
      }
    }
    for (int a = is_far ? (r < 4 ? 0 : r - 3) : 4; a < 4 && a <= r; ++a) {
      const Four row = kBinomial3[r - a] * binomials;
      for (int i = 0; i < 4; ++i) {
        const double linear =
            -2 * (single[0][4 * a + i] * away[0] + single[1][4 * a + i] * away[1] +
                  single[2][4 * a + i] * away[2]);
        shifted[i] = shifted[i] + linear * row;
      }
    }
    double sum[8] = {};
    for (int i = 0; i < 4; ++i) {
      (Four::load(sum + i) + shifted[i]).store(sum + i);
    }
    sum[7] = sum[6];
    (Four::load(sum) * Four::load(kInverse6) * kInverse6[r]).store(out + kDistanceStride * r);
    (Four::load(sum + 4) * Four::load(kInverse6 + 4) * kInverse6[r])
        .store(out + kDistanceStride * r + 4);
  }
}

/// The extremes of numbers that come four at a time.
struct Extremes {
  Extremes() {}  // an implicit one would be compiled for the baseline
  Four low = Four::of(__builtin_inf()), high = Four::of(-__builtin_inf());

  void include(const Four& numbers) {
    low = Four::smaller(low, numbers);
    high = Four::larger(high, numbers);
  }
  void store(double& out_low, double& out_high) const {
    double lows[4], highs[4];
    low.store(lows);
    high.store(highs);
    out_low = lows[0];
    out_high = highs[0];
    for (int i = 1; i < 4; ++i) {
      out_low = lows[i] < out_low ? lows[i] : out_low;
      out_high = out_high < highs[i] ? highs[i] : out_high;
    }
  }
};

inline void extremes(const double c[kDistanceSize], double& least, double& largest) {
  Extremes values;  // the padding repeats coefficients
  for (int i = 0; i < kDistanceSize; i += 4) {
    values.include(Four::load(c + i));
  }
  values.store(least, largest);
}

inline void differenceBounds(const double c[kDistanceSize], DifferenceBounds& out) {
  // A row has seven coefficients, i = 0 to 6: those from 0 on and those from 3 on.
  Extremes s, t, ss, tt, st;
  Four before[2], slope_before[2], t_before[2];
  for (int j = 0; j < 7; ++j) {
    const double* row = c + kDistanceStride * j;
    const Four at0 = Four::load(row), at1 = Four::load(row + 1), at2 = Four::load(row + 2),
               at3 = Four::load(row + 3);
    const Four slope[2] = {at1 - at0, at3 - at2};  // i = 0 to 3, 2 to 5
    s.include(slope[0]);
    s.include(slope[1]);
    ss.include((at0 - 2 * at1) + at2);
    ss.include((at1 - 2 * at2) + at3);
    if (j > 0) {
      const Four rise[2] = {at0 - before[0], at3 - before[1]};
      t.include(rise[0]);
      t.include(rise[1]);
      st.include(slope[0] - slope_before[0]);
      st.include(slope[1] - slope_before[1]);
      if (j > 1) {
        tt.include(rise[0] - t_before[0]);
        tt.include(rise[1] - t_before[1]);
      }
      t_before[0] = rise[0];
      t_before[1] = rise[1];
    }
    before[0] = at0;
    before[1] = at3;
    slope_before[0] = slope[0];
    slope_before[1] = slope[1];
  }
  s.store(out.least_s, out.largest_s);
  t.store(out.least_t, out.largest_t);
  ss.store(out.least_ss, out.largest_ss);
  tt.store(out.least_tt, out.largest_tt);
  st.store(out.least_st, out.largest_st);
}

/// A cubic and its derivatives to the second, by differences, as bezier::cubic().
inline void cubic(const Four& a, const Four& b, const Four& c, const Four& d, double t,
                  Four out[3]) {
  const Four ab = b - a, bc = c - b, cd = d - c;
  const Four abc = ab + t * (bc - ab), bcd = bc + t * (cd - bc);
  const Four p = a + t * ab, q = b + t * bc, r = c + t * cd;
  const Four pq = p + t * (q - p), qr = q + t * (r - q);
  out[0] = pq + t * (qr - pq);
  out[1] = 3 * (abc + t * (bcd - abc));
  out[2] = 6 * (bcd - abc);
}

inline void evaluate(const double points[16][4], double s, double t, double out[6][4]) {
  Four rows[4][3];
  for (int j = 0; j < 4; ++j) {
    cubic(Four::load(points[4 * j]), Four::load(points[4 * j + 1]), Four::load(points[4 * j + 2]),
          Four::load(points[4 * j + 3]), s, rows[j]);
  }
  Four along[3][3];
  for (int k = 0; k < 3; ++k) {
    cubic(rows[0][k], rows[1][k], rows[2][k], rows[3][k], t, along[k]);
  }
  along[0][0].store(out[0]);
  along[1][0].store(out[1]);
  along[0][1].store(out[2]);
  along[2][0].store(out[3]);
  along[1][1].store(out[4]);
  along[0][2].store(out[5]);
}

inline void along(const double points[16][4], const double direction[4], double out[16]) {
  for (int i = 0; i < 16; i += 4) {
    Four sum = Four::of(0);
    for (int axis = 0; axis < 3; ++axis) {
      const double of_points[4] = {points[i][axis], points[i + 1][axis], points[i + 2][axis],
                                   points[i + 3][axis]};
      sum = sum + Four::load(of_points) * direction[axis];
    }
    sum.store(out + i);
  }
}

constexpr SearchKernels kKernels = {move, squaredDistance, extremes, differenceBounds, evaluate,
                                    along};
