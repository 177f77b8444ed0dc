// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace limitsurf {

/// Rows of a batch on one tile, with the tile's parameters. PatchRun::kReadBeyond more numbers can
/// be read behind u and v.
struct TileRows {
  double *u, *v;
  std::size_t* rows;
  unsigned count;
};

/// Sorts the rows on a tile into four parts: part (u >= bound) + 2 (v >= bound). Compilers make no
/// vector instructions of such loops, so that they are written by hand, for AVX-512 alone.
struct PartKernels {
  static constexpr unsigned kParts = 4;

  /// The number of rows in each part.
  void (*count)(const TileRows& rows, double bound, unsigned counts[kParts]);
  /// Writes the rows of each part to `to`, from place next[part] on, in the order in which they
  /// are given. Then next[part] is the place behind them.
  void (*sort)(const TileRows& rows, double bound, unsigned next[kParts], const TileRows& to);
  /// The same with the bound 1/2 and with the parameters of the four children of a split tile.
  /// These are distances from the edges at the child's corner, times 2, and change places in parts
  /// 1 and 2.
  void (*sortByChild)(const TileRows& rows, unsigned next[kParts], const TileRows& to);

  /// Null if the instruction set in use has none.
  static const PartKernels* get();
};

}  // namespace limitsurf
