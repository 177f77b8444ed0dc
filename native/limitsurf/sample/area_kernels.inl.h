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

inline void squareShapes(const SquareBlock& squares, SquareShapes& out) {
  constexpr double kRounding = 4e-15;
  for (int first = 0; first < SquareBlock::kCount; first += kLanes) {
    const SquareDerivatives d(squares, first);
    (kRounding * largestCoordinate(d.ds) * largestCoordinate(d.dt)).store(out.rounding + first);
    uprightness(d).store(out.upright + first);
  }
}

/// A polynomial in powers of the distance from the middle.
struct CenteredCubic {
  Squares c[4];

  static CenteredCubic of(const Squares& p0, const Squares& p1, const Squares& p2,
                          const Squares& p3) {
    const Squares whole = p3 - p0, middle = p2 - p1;
    return {{0.125 * ((p0 + p3) + 3 * (p1 + p2)), 0.75 * (whole + middle),
             1.5 * ((p0 + p3) - (p1 + p2)), whole - 3 * middle}};
  }
};

/// The derivatives of bicubic patches in powers of the distances from their middle, as
/// [power of t][power of s].
struct CenteredDerivatives {
  CenteredDerivatives(const SquareBlock& squares, int first) {
    for (int axis = 0; axis < 3; ++axis) {
      CenteredCubic rows[4];
      for (int row = 0; row < 4; ++row) {
        const double (*p)[SquareBlock::kCount] = squares.points[axis] + 4 * row;
        rows[row] = CenteredCubic::of(Squares::load(p[0] + first), Squares::load(p[1] + first),
                                      Squares::load(p[2] + first), Squares::load(p[3] + first));
      }
      for (int i = 0; i < 4; ++i) {
        const CenteredCubic column =
            CenteredCubic::of(rows[0].c[i], rows[1].c[i], rows[2].c[i], rows[3].c[i]);
        for (int j = 0; j < 4; ++j) {
          if (i > 0) {
            ds[axis][j][i - 1] = static_cast<double>(i) * column.c[j];
          }
          if (j > 0) {
            dt[axis][j - 1][i] = static_cast<double>(j) * column.c[j];
          }
        }
      }
    }
  }

  Squares ds[3][4][3], dt[3][3][4];
};

/// Values at two places at the same distance from the middle, before and beyond it.
struct PairOfValues {
  Squares before, beyond;

  static PairOfValues ofQuadratic(const Squares& c0, const Squares& c1, const Squares& c2,
                                  double at) {
    return of(c0 + (at * at) * c2, at * c1);
  }
  static PairOfValues ofCubic(const Squares& c0, const Squares& c1, const Squares& c2,
                              const Squares& c3, double at) {
    return of(c0 + (at * at) * c2, at * (c1 + (at * at) * c3));
  }
  static PairOfValues of(const Squares& even, const Squares& odd) {
    return {even - odd, even + odd};
  }
};

/// ds x dt, integrated over each square: half the integral of p x dp around it, which follows from
/// the points of its sides.
inline SquareVector integratedNormal(const SquareBlock& squares, int first) {
  const auto between = [&](int from, int to) {
    SquareVector difference;
    for (int axis = 0; axis < 3; ++axis) {
      difference.axis[axis] = Squares::load(squares.points[axis][to] + first) -
                              Squares::load(squares.points[axis][from] + first);
    }
    return difference;
  };
  SquareVector sum = crossProduct(between(0, 15), between(3, 12));
  for (Squares& coordinate : sum.axis) {
    coordinate = 0.5 * coordinate;
  }
  constexpr struct {
    int begin, step;
    double sign;
  } kSides[4] = {{0, 1, 1}, {3, 4, 1}, {12, 1, -1}, {0, 4, -1}};
  for (const auto& side : kSides) {
    const SquareVector a = between(side.begin, side.begin + side.step),
                       b = between(side.begin, side.begin + 2 * side.step),
                       c = between(side.begin, side.begin + 3 * side.step);
    const SquareVector first_part = crossProduct(
        a, SquareVector{{b.axis[0] + c.axis[0], b.axis[1] + c.axis[1], b.axis[2] + c.axis[2]}});
    const SquareVector second_part = crossProduct(b, c);
    for (int axis = 0; axis < 3; ++axis) {
      sum.axis[axis] = sum.axis[axis] +
                       (0.15 * side.sign) * (first_part.axis[axis] + 2 * second_part.axis[axis]);
    }
  }
  return sum;
}

/// Values at the points of a rule. In each direction, those beyond the middle come first, then
/// their partners.
template <int N>
using RuleValues = Squares[N][N];

/// Sets `lengths` to |ds x dt| and `excess` to what this is more than the part along `normal`.
template <int N>
inline void evaluate(const CenteredDerivatives& d, const PairedRule<N>& rule,
                     const SquareVector& normal, RuleValues<N>& lengths, RuleValues<N>& excess) {
  constexpr int kPairs = N / 2;
  for (int j = 0; j < kPairs; ++j) {
    Squares p[2][3][3], q[2][3][4];
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 3; ++i) {
        const PairOfValues pair = PairOfValues::ofCubic(
            d.ds[axis][0][i], d.ds[axis][1][i], d.ds[axis][2][i], d.ds[axis][3][i], rule.offset[j]);
        p[0][axis][i] = pair.beyond;
        p[1][axis][i] = pair.before;
      }
      for (int i = 0; i < 4; ++i) {
        const PairOfValues pair = PairOfValues::ofQuadratic(d.dt[axis][0][i], d.dt[axis][1][i],
                                                            d.dt[axis][2][i], rule.offset[j]);
        q[0][axis][i] = pair.beyond;
        q[1][axis][i] = pair.before;
      }
    }
    for (int half = 0; half < 2; ++half) {
      const int row = j + half * kPairs;
      for (int i = 0; i < kPairs; ++i) {
        SquareVector s[2], t[2];
        for (int axis = 0; axis < 3; ++axis) {
          const Squares *a = p[half][axis], *b = q[half][axis];
          const PairOfValues ds = PairOfValues::ofQuadratic(a[0], a[1], a[2], rule.offset[i]);
          const PairOfValues dt = PairOfValues::ofCubic(b[0], b[1], b[2], b[3], rule.offset[i]);
          s[0].axis[axis] = ds.beyond;
          s[1].axis[axis] = ds.before;
          t[0].axis[axis] = dt.beyond;
          t[1].axis[axis] = dt.before;
        }
        for (int side = 0; side < 2; ++side) {
          const SquareVector product = crossProduct(s[side], t[side]);
          const Squares length = squareRoot(squaredLength(product));
          lengths[row][i + side * kPairs] = length;
          excess[row][i + side * kPairs] = length - dotProduct(product, normal);
        }
      }
    }
  }
}

template <int N>
inline Squares integral(const RuleValues<N>& values, const PairedRule<N>& rule) {
  constexpr int kPairs = N / 2;
  Squares sum = Squares::of(0);
  for (int j = 0; j < N; ++j) {
    Squares row = Squares::of(0);
    for (int i = 0; i < kPairs; ++i) {
      row = row + rule.weight[i] * (values[j][i] + values[j][i + kPairs]);
    }
    sum = sum + rule.weight[j % kPairs] * row;
  }
  return sum;
}

/// The squared norms of the Legendre coefficients of two degrees (RuleResults). The sum over rows
/// and columns does not come out small by accident, as one coefficient may.
template <int N>
inline void coefficientNorms(const RuleValues<N>& values, const PairedRule<N>& rule,
                             Squares& highest, Squares& lower) {
  constexpr int kPairs = N / 2;
  highest = lower = Squares::of(0);
  for (int line = 0; line < N; ++line) {
    Squares high[2] = {Squares::of(0), Squares::of(0)}, low[2] = {high[0], high[0]};
    for (int i = 0; i < kPairs; ++i) {
      const Squares differences[2] = {values[line][i] - values[line][i + kPairs],
                                      values[i][line] - values[i + kPairs][line]};
      for (int way = 0; way < 2; ++way) {
        high[way] = high[way] + rule.highest[i] * differences[way];
        low[way] = low[way] + rule.lower[i] * differences[way];
      }
    }
    const double weight = rule.weight[line % kPairs];
    highest = highest + weight * (high[0] * high[0] + high[1] * high[1]);
    lower = lower + weight * (low[0] * low[0] + low[1] * low[1]);
  }
  highest = (2 * PairedRule<N>::kHighest + 1) * highest;
  lower = (2 * PairedRule<N>::kLower + 1) * lower;
}

template <int N>
inline void ruleResults(const SquareBlock& squares, const PairedRule<N>& rule, RuleResults& out) {
  for (int first = 0; first < SquareBlock::kCount; first += kLanes) {
    SquareVector normal = integratedNormal(squares, first);
    const Squares length = squareRoot(squaredLength(normal));
    const Squares scale = Squares::of(1) / Squares::unlessZero(length, Squares::of(1));
    for (int axis = 0; axis < 3; ++axis) {
      normal.axis[axis].store(out.normal[axis] + first);
      normal.axis[axis] = scale * normal.axis[axis];
    }
    RuleValues<N> lengths, excess;
    evaluate(CenteredDerivatives(squares, first), rule, normal, lengths, excess);
    integral(lengths, rule).store(out.area + first);
    Squares highest, lower;
    coefficientNorms(excess, rule, highest, lower);
    highest.store(out.highest + first);
    lower.store(out.lower + first);
  }
}

inline void fourPoints(const SquareBlock& squares, RuleResults& out) {
  ruleResults(squares, kGauss4, out);
}
inline void sixPoints(const SquareBlock& squares, RuleResults& out) {
  ruleResults(squares, kGauss6, out);
}
inline void eightPoints(const SquareBlock& squares, RuleResults& out) {
  ruleResults(squares, kGauss8, out);
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

constexpr AreaKernels kKernels = {squareShapes, fourPoints,     sixPoints,
                                  eightPoints,  boundsAndMeans, normalBounds};
