// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "limitsurf/patch/tile_table.h"
#include "limitsurf/surface/tile_evaluator.h"

namespace limitsurf {

/// What is known of locations that stay while the mesh deforms. Each is in one of three lists,
/// whose rows are in order; but in each block of rows, those with weights are sorted by their
/// number.
struct FixedRows {
  using Row = std::uint32_t;
  /// The weights of a row take as long as many evaluations, so that a task has few rows.
  static constexpr std::size_t kRowsPerBlock = 64;

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
  /// place(row) returns where the location of a row lies. `order` is that of the derivatives, 0 or
  /// 1.
  FixedRows(const TileTable& table, std::size_t count,
            const std::function<TileLocation(std::size_t)>& place, int order, int threads);

  std::size_t bytes() const;

  /// Whether a location is one of `single`.
  static bool isSingle(const TileTable& table, const TileLocation& at);
  /// Whether a location is one of `posed` because its ring alone has so many points.
  static bool isOnLargeRing(const TileTable& table, const TileLocation& at);

  Single single;
  Weighted weighted;
  Posed posed;

 private:
  class Builder;
};

}  // namespace limitsurf
