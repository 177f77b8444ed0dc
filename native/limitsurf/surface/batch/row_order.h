// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/location_batch.h"

namespace limitsurf {

/// The order in which the rows of a batch are evaluated: as they are given if most rows follow
/// another one of their face, or if there are far fewer rows than faces, and face by face
/// otherwise. What a face needs is then read once for all its rows.
///
/// If there are few rows on each face and the results are large, only rows on irregular faces are
/// sorted; those on regular faces come before them as they are given. Each of them reads its face
/// again, but their results are written one behind the other. Cost: O(rows).
class RowOrder {
 public:
  /// The batch need not have been checked. Its results take so many bytes a row.
  RowOrder(const LocationBatch& at, const TileTable& table, std::size_t result_bytes, int threads);

  /// Whether rows come in another order than they are given.
  bool isSorted() const { return !rows_.empty(); }
  /// The row that comes at place i.
  std::size_t operator[](std::size_t i) const { return rows_.empty() ? i : rows_[i]; }

 private:
  std::vector<std::uint32_t> rows_;
};

}  // namespace limitsurf
