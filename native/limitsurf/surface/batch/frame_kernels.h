// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limitsurf {

/// Frames of many rows at once, for the instruction set that is in use.
struct FrameKernels {
  static constexpr int kMostRows = 8;

  /// What frame() gives for each of `count` rows, at most kMostRows, to the bit: 3 x 3 rotations,
  /// row-major, from du and the normal (three numbers a row, one row after the other). Returns a
  /// bit for each row, from the lowest one on, which is 0 where lengths are so small or so large
  /// that frame() must decide; what is written there has no meaning.
  unsigned (*frames)(const double* du, const double* normal, double* rotations, int count);

  static const FrameKernels& get();
};

}  // namespace limitsurf
