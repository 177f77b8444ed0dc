// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/location_batch.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// What is known of locations that stay while the mesh deforms. Each is in one of three lists,
/// whose rows are in order; but of each 64 rows, those with weights are sorted by their number.
struct FixedRows {
  using Row = std::uint32_t;

  /// Locations on regular tiles that are whole Ptex faces with vertices of the control mesh alone
  /// (SingleRun).
  struct Single {
    std::vector<Row> rows;
    std::vector<std::uint32_t> tiles;
    std::vector<double> u, v;  ///< with PatchRun::kReadBeyond numbers behind them
  };
  /// Locations with weights, as a WeightedRun has them.
  struct Weighted {
    std::vector<Row> rows;
    std::vector<std::size_t> offsets{0};
    std::vector<int> indices;
    std::vector<double> weights;
  };
  /// Locations that depend on more than FixedSamples::kMostWeights vertices.
  struct Posed {
    std::vector<Row> rows;
    std::vector<TileLocation> at;
  };

  FixedRows() = default;
  /// The locations must have been checked. `order` is that of the derivatives, 0 or 1.
  FixedRows(const LocationBatch& at, const TileEvaluator& evaluator, const TileTable& table,
            int order, int threads);

  std::size_t bytes() const;

  Single single;
  Weighted weighted;
  Posed posed;

 private:
  class Builder;
};

}  // namespace limitsurf
