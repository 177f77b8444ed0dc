// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "limitsurf/surface/batch/part_kernels.h"
#include "limitsurf/unset_vector.h"

namespace limitsurf {

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

  /// Whether sortByQuarterAfter() takes less time than it saves.
  bool sortsFast() const { return kernels_ != nullptr; }
  /// Where sortsFast(): by the quarters of a ring tile after those steps, with the tile's
  /// parameters: quarter (a, b) is part a + 2 b, and part 0 holds all deeper rows, too.
  void sortByQuarterAfter(int steps, const TileRows& rows);

  /// Calls body(part, rows of the part) for each part that has rows, in increasing order.
  template <typename Body>
  void forEachPart(const Body& body) {
    for (unsigned first = 0; first < count_;) {
      const unsigned part = sorted()[first], end = end_[part];
      const TileRows all = sortedRows();
      body(part, TileRows{all.u + first, all.v + first, all.rows + first, end - first});
      first = end;
    }
  }

 private:
  static constexpr unsigned kParts = 4 * (kMostSteps + 1);

  void reserve(unsigned count);
  /// Makes end_, which counts the rows of each part, the place where the part begins.
  void beginParts(unsigned last);
  /// Where the sorted rows go.
  TileRows sortedRows() {
    double* const u = parameters_.data();
    return {u, u + parameters_.size() / 2, rows_.data(), count_};
  }
  /// The part of the first row of each part, as sorted.
  std::uint8_t* sorted() { return part_.data() + rows_.size(); }

  const PartKernels* const kernels_ = PartKernels::get();
  unsigned count_ = 0;
  unsigned end_[kParts] = {};
  // Few vectors, because each of them takes memory for each task of a batch.
  UnsetVector<double> parameters_;  // u of all sorted rows, then v
  UnsetVector<std::size_t> rows_;
  UnsetVector<std::uint8_t> part_;  // of each row as given; then sorted()
};

}  // namespace limitsurf
