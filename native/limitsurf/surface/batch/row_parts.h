// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limitsurf {

/// Rows of a batch on one tile, with the tile's parameters. PatchRun::kReadBeyond more numbers can
/// be read behind u and v.
struct TileRows {
  double *u, *v;
  std::size_t* rows;
  unsigned count;
};

/// Sorts the rows on a tile by the parts of the tile. What it sorts stays in its memory until the
/// next time. To which part a row belongs no processor can guess, so that the loops over rows do
/// not branch on it.
class RowParts {
 public:
  /// Deeper quarters of a ring tile, where few locations lie, have no part of their own.
  static constexpr unsigned kMostSteps = 63;
  /// Of all rows in deeper quarters.
  static constexpr unsigned kDeep = 0;

  /// By the four children of a split tile, with the children's parameters.
  void sortByChild(const TileRows& rows);

  /// By the quarters of a ring tile, with the tile's parameters: quarter (a, b) after some steps is
  /// part 4 steps + a + 2 b. If `spokes_are_deep`, rows with u = 0 or v = 0 belong to kDeep as
  /// well.
  void sortByQuarter(const TileRows& rows, bool spokes_are_deep);

  /// Calls body(part, rows of the part) for each part that has rows, in increasing order.
  template <typename Body>
  void forEachPart(const Body& body) {
    for (unsigned first = 0; first < count_;) {
      const unsigned part = sorted_[first], end = end_[part];
      body(part, TileRows{&u_[first], &v_[first], &rows_[first], end - first});
      first = end;
    }
  }

 private:
  static constexpr unsigned kParts = 4 * (kMostSteps + 1);

  void reserve(unsigned count);
  /// Makes end_, which counts the rows of each part, the place where the part begins.
  void beginParts(unsigned last);

  unsigned count_ = 0;
  unsigned end_[kParts] = {};
  std::vector<double> u_, v_;
  std::vector<std::size_t> rows_;
  std::vector<std::uint8_t> part_;    // by row as given
  std::vector<std::uint8_t> sorted_;  // the same by row as sorted
};

}  // namespace limitsurf
