// SPDX-License-Identifier: Apache-2.0
//
// Frames of several rows at once. kernels_by_set.inl.h compiles this file for each instruction set,
// where kLanes and squareRoot() are defined. Nothing here may call a function that is defined
// elsewhere: its code could be that of another set.

#include "limitsurf/surface/batch/lane_vectors.inl.h"

/// kLanes rows at a time.
using Rows = Lanes<kLanes>;

/// Their dotProduct() adds in the order of frame().
using RowVector = LaneVectors<kLanes>;

/// v over its length, whose square is given.
inline RowVector direction(const RowVector& v, const Rows& square) {
  const Rows length = squareRoot(square);
  return {{v.axis[0] / length, v.axis[1] / length, v.axis[2] / length}};
}

/// Rows from `begin` on; beyond the last one it is repeated.
inline RowVector gatherRows(const double* from, int begin, int count) {
  double numbers[3][kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    const int row = begin + lane < count ? begin + lane : count - 1;
    for (int axis = 0; axis < 3; ++axis) {
      numbers[axis][lane] = from[3 * row + axis];
    }
  }
  return {{Rows::load(numbers[0]), Rows::load(numbers[1]), Rows::load(numbers[2])}};
}

/// Whether the square of a length has lost no digits. It is false for NaN.
inline bool isPlain(double square) { return square >= 0x1p-900 && square <= 0x1p900; }

inline unsigned frameRows(const double* du, const double* normal, double* rotations, int count) {
  unsigned plain = 0;
  for (int begin = 0; begin < count; begin += kLanes) {
    const RowVector along = gatherRows(du, begin, count), up = gatherRows(normal, begin, count);
    Rows squares[3] = {dotProduct(along, along), dotProduct(up, up)};
    const RowVector n = direction(up, squares[1]);
    const RowVector first = direction(along, squares[0]);
    const Rows lift = dotProduct(first, n);
    RowVector flat;
    for (int axis = 0; axis < 3; ++axis) {
      flat.axis[axis] = first.axis[axis] - lift * n.axis[axis];
    }
    squares[2] = dotProduct(flat, flat);
    const RowVector tangent = direction(flat, squares[2]), across = crossProduct(n, tangent);
    double tested[3][kLanes], columns[3][3][kLanes];
    for (int i = 0; i < 3; ++i) {
      squares[i].store(tested[i]);
      tangent.axis[i].store(columns[i][0]);
      across.axis[i].store(columns[i][1]);
      n.axis[i].store(columns[i][2]);
    }
    for (int lane = 0; lane < kLanes && begin + lane < count; ++lane) {
      double* const rotation = rotations + 9 * (begin + lane);
      for (int i = 0; i < 9; ++i) {
        rotation[i] = columns[i / 3][i % 3][lane];
      }
      const bool is_plain =
          isPlain(tested[0][lane]) && isPlain(tested[1][lane]) && isPlain(tested[2][lane]);
      plain |= static_cast<unsigned>(is_plain) << (begin + lane);
    }
  }
  return plain;
}

constexpr FrameKernels kKernels = {&frameRows};
