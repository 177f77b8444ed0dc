// SPDX-License-Identifier: Apache-2.0
//
// Quadratures of |ds x dt| on several squares at once. kernels_by_set.inl.h compiles this file for
// each instruction set, where kLanes and squareRoot() are defined. Nothing here may call a function
// that is defined elsewhere: its code could be that of another set.

#include "limitsurf/surface/batch/lane_vectors.inl.h"

/// kLanes squares at a time.
using Squares = Lanes<kLanes>;

using SquareVector = LaneVectors<kLanes>;

/// The derivatives of bicubic patches, in Bezier form.
struct SquareDerivatives {
  SquareDerivatives(const SquareBlock& squares, int first) {
    for (int axis = 0; axis < 3; ++axis) {
      Squares p[16];
      for (int i = 0; i < 16; ++i) {
        p[i] = Squares::load(squares.points[axis][i] + first);
      }
      for (int row = 0; row < 4; ++row) {
        for (int i = 0; i < 3; ++i) {
          ds[axis][row][i] = 3 * (p[4 * row + i + 1] - p[4 * row + i]);
        }
      }
      for (int row = 0; row < 3; ++row) {
        for (int i = 0; i < 4; ++i) {
          dt[axis][row][i] = 3 * (p[4 * row + 4 + i] - p[4 * row + i]);
        }
      }
    }
  }

  Squares ds[3][4][3], dt[3][3][4];
};

template <int N>
inline Squares quadrature(const SquareDerivatives& d, const GaussRule<N>& rule) {
  Squares sum = Squares::of(0);
  for (int j = 0; j < N; ++j) {
    Squares p[3][3], q[3][4];
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 3; ++i) {
        p[axis][i] = (rule.cubic[j][0] * d.ds[axis][0][i] + rule.cubic[j][1] * d.ds[axis][1][i]) +
                     (rule.cubic[j][2] * d.ds[axis][2][i] + rule.cubic[j][3] * d.ds[axis][3][i]);
      }
      for (int i = 0; i < 4; ++i) {
        q[axis][i] = rule.quadratic[j][0] * d.dt[axis][0][i] +
                     rule.quadratic[j][1] * d.dt[axis][1][i] +
                     rule.quadratic[j][2] * d.dt[axis][2][i];
      }
    }
    Squares row = Squares::of(0);
    for (int i = 0; i < N; ++i) {
      SquareVector s, t;
      for (int axis = 0; axis < 3; ++axis) {
        s.axis[axis] = rule.quadratic[i][0] * p[axis][0] + rule.quadratic[i][1] * p[axis][1] +
                       rule.quadratic[i][2] * p[axis][2];
        t.axis[axis] = (rule.cubic[i][0] * q[axis][0] + rule.cubic[i][1] * q[axis][1]) +
                       (rule.cubic[i][2] * q[axis][2] + rule.cubic[i][3] * q[axis][3]);
      }
      row = row + rule.weight[i] * squareRoot(squaredLength(crossProduct(s, t)));
    }
    sum = sum + rule.weight[j] * row;
  }
  return sum;
}

/// The largest coordinate of vectors, without its sign.
template <int kRows, int kColumns>
inline Squares largestCoordinate(const Squares (&vectors)[3][kRows][kColumns]) {
  Squares largest = Squares::of(0);
  for (int axis = 0; axis < 3; ++axis) {
    for (int row = 0; row < kRows; ++row) {
      for (int i = 0; i < kColumns; ++i) {
        const Squares& a = vectors[axis][row][i];
        largest = Squares::larger(largest, Squares::larger(a, Squares::of(0) - a));
      }
    }
  }
  return largest;
}

/// The mean of Bezier points in which those in the middle count most, as in the derivative in the
/// middle of the square, and the largest squared distance of one of them from it.
template <int kRows, int kColumns>
inline void meanAndSpread(const Squares (&vectors)[3][kRows][kColumns], SquareVector& mean,
                          Squares& spread) {
  constexpr double kThree[3] = {0.25, 0.5, 0.25}, kFour[4] = {0.125, 0.375, 0.375, 0.125};
  for (int axis = 0; axis < 3; ++axis) {
    mean.axis[axis] = Squares::of(0);
    for (int row = 0; row < kRows; ++row) {
      for (int i = 0; i < kColumns; ++i) {
        const double weight = kRows == 4 ? kFour[row] * kThree[i] : kThree[row] * kFour[i];
        mean.axis[axis] = mean.axis[axis] + weight * vectors[axis][row][i];
      }
    }
  }
  spread = Squares::of(0);
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kColumns; ++i) {
      const SquareVector off = {{vectors[0][row][i] - mean.axis[0],
                                 vectors[1][row][i] - mean.axis[1],
                                 vectors[2][row][i] - mean.axis[2]}};
      spread = Squares::larger(spread, squaredLength(off));
    }
  }
}

/// |s x t| in the middle, less a bound on how far ds x dt differs from it: if that is above 0, ds x
/// dt turns nowhere.
inline Squares uprightness(const SquareDerivatives& d) {
  SquareVector s, t;
  Squares s_spread, t_spread;
  meanAndSpread(d.ds, s, s_spread);
  meanAndSpread(d.dt, t, t_spread);
  const Squares a = squareRoot(s_spread), b = squareRoot(t_spread);
  const Squares change =
      a * squareRoot(squaredLength(t)) + b * squareRoot(squaredLength(s)) + a * b;
  constexpr double kMoreThanRounding = 1 + 1e-9;
  return squareRoot(squaredLength(crossProduct(s, t))) - kMoreThanRounding * change;
}

inline void firstRules(const SquareBlock& squares, FirstRules& out) {
  constexpr double kRounding = 4e-15;
  for (int first = 0; first < SquareBlock::kCount; first += kLanes) {
    const SquareDerivatives d(squares, first);
    quadrature(d, kGauss1).store(out.one + first);
    quadrature(d, kGauss2).store(out.two + first);
    quadrature(d, kGauss3).store(out.three + first);
    (kRounding * largestCoordinate(d.ds) * largestCoordinate(d.dt)).store(out.rounding + first);
    uprightness(d).store(out.upright + first);
  }
}

template <int N>
inline void areas(const SquareBlock& squares, const GaussRule<N>& rule,
                  double out[SquareBlock::kCount]) {
  for (int first = 0; first < SquareBlock::kCount; first += kLanes) {
    quadrature(SquareDerivatives(squares, first), rule).store(out + first);
  }
}

inline void fourPoints(const SquareBlock& squares, double out[SquareBlock::kCount]) {
  areas(squares, kGauss4, out);
}
inline void sixPoints(const SquareBlock& squares, double out[SquareBlock::kCount]) {
  areas(squares, kGauss6, out);
}
inline void eightPoints(const SquareBlock& squares, double out[SquareBlock::kCount]) {
  areas(squares, kGauss8, out);
}

/// Calls visit() for the 36 Bezier points of ds x dt, which is of degree 5 in both directions.
template <typename Visit>
inline void forEachNormal(const SquareDerivatives& d, const Visit& visit) {
  // Product of Bernstein polynomials: the binomials of the factors over those of the product.
  constexpr double kTwo[3] = {1, 2, 1}, kThree[4] = {1, 3, 3, 1};
  constexpr double kFive[6] = {1, 5, 10, 10, 5, 1};
  for (int row = 0; row < 6; ++row) {
    SquareVector form[6];
    for (SquareVector& point : form) {
      point = {{Squares::of(0), Squares::of(0), Squares::of(0)}};
    }
    for (int j = row < 2 ? 0 : row - 2; j < 4 && j <= row; ++j) {
      const int l = row - j;
      for (int i = 0; i < 3; ++i) {
        const double s_weight = kThree[j] * kTwo[i] * kTwo[l];
        const SquareVector s = {
            {s_weight * d.ds[0][j][i], s_weight * d.ds[1][j][i], s_weight * d.ds[2][j][i]}};
        for (int k = 0; k < 4; ++k) {
          const SquareVector t = {
              {kThree[k] * d.dt[0][l][k], kThree[k] * d.dt[1][l][k], kThree[k] * d.dt[2][l][k]}};
          const SquareVector product = crossProduct(s, t);
          for (int axis = 0; axis < 3; ++axis) {
            form[i + k].axis[axis] = form[i + k].axis[axis] + product.axis[axis];
          }
        }
      }
    }
    for (int i = 0; i < 6; ++i) {
      const double weight = 1 / (kFive[i] * kFive[row]);
      visit(SquareVector{
          {weight * form[i].axis[0], weight * form[i].axis[1], weight * form[i].axis[2]}});
    }
  }
}

/// The largest length of these points, and the least part of one along the normal in the middle.
inline void lengthBounds(const SquareDerivatives& d, Squares& largest, Squares& least) {
  SquareVector s, t;
  Squares unused;
  meanAndSpread(d.ds, s, unused);
  meanAndSpread(d.dt, t, unused);
  SquareVector upright = crossProduct(s, t);
  const Squares length = squareRoot(squaredLength(upright));
  for (Squares& coordinate : upright.axis) {
    coordinate = coordinate / length;
  }
  Squares square = Squares::of(0);
  least = length;
  forEachNormal(d, [&](const SquareVector& normal) {
    square = Squares::larger(square, squaredLength(normal));
    least = Squares::smaller(least, dotProduct(normal, upright));
  });
  largest = squareRoot(square);
}

inline void normalBounds(const SquareBlock& squares, int count, NormalBounds& out) {
  constexpr double kMoreThanRounding = 1 + 1e-9;
  for (int first = 0; first < count; first += kLanes) {
    SquareVector normals[36], mean = {{Squares::of(0), Squares::of(0), Squares::of(0)}};
    int number = 0;
    forEachNormal(SquareDerivatives(squares, first), [&](const SquareVector& normal) {
      normals[number++] = normal;
      for (int axis = 0; axis < 3; ++axis) {
        mean.axis[axis] = mean.axis[axis] + normal.axis[axis];
      }
    });
    for (int axis = 0; axis < 3; ++axis) {
      mean.axis[axis] = mean.axis[axis] / 36;
      mean.axis[axis].store(out.mean[axis] + first);
    }
    Squares farthest = Squares::of(0);
    for (const SquareVector& normal : normals) {
      const SquareVector off = {{normal.axis[0] - mean.axis[0], normal.axis[1] - mean.axis[1],
                                 normal.axis[2] - mean.axis[2]}};
      farthest = Squares::larger(farthest, squaredLength(off));
    }
    (kMoreThanRounding * squareRoot(farthest)).store(out.reach + first);
  }
}

inline void boundsAndMeans(const SquareBlock& squares, int count,
                           double bounds[SquareBlock::kCount], double means[SquareBlock::kCount],
                           double least[SquareBlock::kCount]) {
  constexpr double kMoreThanRounding = 1 + 1e-12, kLessThanRounding = 1 - 1e-12;
  for (int first = 0; first < count; first += kLanes) {
    const SquareDerivatives d(squares, first);
    Squares high, low;
    lengthBounds(d, high, low);
    (kMoreThanRounding * high).store(bounds + first);
    (kLessThanRounding * low).store(least + first);
    quadrature(d, kGauss3).store(means + first);
  }
}

constexpr AreaKernels kKernels = {firstRules,  fourPoints,     sixPoints,
                                  eightPoints, boundsAndMeans, normalBounds};
