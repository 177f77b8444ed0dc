// SPDX-License-Identifier: Apache-2.0
#include "limitsurf/surface/fixed/fixed_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limitsurf/parallel.h"
#include "limitsurf/surface/batch/patch_run.h"
#include "limitsurf/surface/fixed/fixed_samples.h"
#include "limitsurf/surface/stencils/stencil_row.h"

namespace limitsurf {

bool FixedRows::isSingle(const TileTable& table, const TileLocation& at) {
  if (at.tile.kind != TileRef::kBSpline || at.depth > 0 || at.turns > 0) {
    return false;
  }
  const BSplineTile& tile = table.bsplines[at.tile.index];
  return !tile.hasEnds() && !tile.fine && tile.crease == 0 && table.isOnVertices(tile);
}

bool FixedRows::isOnLargeRing(const TileTable& table, const TileLocation& at) {
  return at.tile.kind == TileRef::kRing &&
         table.rings[table.ring_tiles[at.tile.index].ring].points.size() >
             FixedSamples::kMostWeights;
}

/// Makes some of the rows.
class FixedRows::Builder {
 public:
  Builder(const TileTable& table, int order, FixedRows& out)
      : table_(table), order_(order), out_(out), weights_(table) {}

  void add(Row row, const TileLocation& at) {
    if (isSingle(table_, at)) {
      Single& on_tile = out_.single;
      on_tile.rows.push_back(row);
      on_tile.tiles.push_back(at.tile.index);
      on_tile.u.push_back(at.u);
      on_tile.v.push_back(at.v);
    } else if (hasFewWeights(at)) {
      addWeights(row);
    } else {
      out_.posed.rows.push_back(row);
      out_.posed.at.push_back(at);
    }
  }

  /// To be called at the end. Rows with equally many weights come one after the other: processors
  /// guess then how long each of them is.
  void finish() {
    std::stable_sort(weighted_.begin(), weighted_.end(),
                     [](const WeightedRow& a, const WeightedRow& b) {
                       return a.entries.size() < b.entries.size();
                     });
    Weighted& out = out_.weighted;
    for (const WeightedRow& row : weighted_) {
      for (const StencilRow::Entry& entry : row.entries) {
        out.indices.push_back(entry.vertex);
        if (&entry != &row.entries.front()) {
          const double* const weights = entry.weights.data();
          out.weights.insert(out.weights.end(), weights, weights + (order_ == 0 ? 1 : 3));
        }
      }
      out.rows.push_back(row.row);
      out.offsets.push_back(out.indices.size());
    }
  }

 private:
  /// If it is true, the weights have been set.
  bool hasFewWeights(const TileLocation& at) {
    if (isOnLargeRing(table_, at)) {
      return false;
    }
    weights_.set(at, order_);
    return weights_.entries().size() <= FixedSamples::kMostWeights;
  }

  void addWeights(Row row) {
    using Entry = StencilRow::Entry;
    const std::vector<Entry>& entries = weights_.entries();
    const auto anchor =
        std::max_element(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
          return std::abs(a.weights[0]) < std::abs(b.weights[0]);
        });
    weighted_.push_back({row, entries});
    std::swap(weighted_.back().entries.front(),
              weighted_.back().entries[static_cast<std::size_t>(anchor - entries.begin())]);
  }

  struct WeightedRow {
    Row row;
    std::vector<StencilRow::Entry> entries;  // the anchor first
  };
  std::vector<WeightedRow> weighted_;
  const TileTable& table_;
  int order_;
  FixedRows& out_;
  StencilRow weights_;
};

FixedRows::FixedRows(const TileTable& table, std::size_t count,
                     const std::function<TileLocation(std::size_t)>& place, int order,
                     int threads) {
  std::vector<FixedRows> blocks((count + kRowsPerBlock - 1) / kRowsPerBlock);
  parallelFor(count, kRowsPerBlock, threads, [&](std::size_t begin, std::size_t end) {
    Builder builder(table, order, blocks[begin / kRowsPerBlock]);
    for (std::size_t row = begin; row < end; ++row) {
      builder.add(static_cast<Row>(row), place(row));
    }
    builder.finish();
  });

  const auto join = [&](auto& to, std::size_t beyond, const auto& of) {
    to.reserve(std::accumulate(
        blocks.begin(), blocks.end(), to.size() + beyond,
        [&](std::size_t sum, const FixedRows& block) { return sum + of(block).size(); }));
    InterruptionStride stride;
    for (const FixedRows& block : blocks) {
      stride.step();
      to.insert(to.end(), of(block).begin(), of(block).end());
    }
    to.resize(to.size() + beyond);
  };
  const auto beyond = static_cast<std::size_t>(PatchRun::kReadBeyond);
  join(single.rows, 0, [](const FixedRows& b) -> const auto& { return b.single.rows; });
  join(single.tiles, 0, [](const FixedRows& b) -> const auto& { return b.single.tiles; });
  join(single.u, beyond, [](const FixedRows& b) -> const auto& { return b.single.u; });
  join(single.v, beyond, [](const FixedRows& b) -> const auto& { return b.single.v; });
  join(weighted.rows, 0, [](const FixedRows& b) -> const auto& { return b.weighted.rows; });
  join(weighted.weights, 0, [](const FixedRows& b) -> const auto& { return b.weighted.weights; });
  weighted.offsets.reserve(weighted.rows.size() + 1);
  std::size_t before = 0;
  for (const FixedRows& block : blocks) {
    const std::vector<std::size_t>& offsets = block.weighted.offsets;
    std::transform(offsets.begin() + 1, offsets.end(), std::back_inserter(weighted.offsets),
                   [&](std::size_t offset) { return before + offset; });
    before += block.weighted.indices.size();
  }
  join(weighted.indices, 0, [](const FixedRows& b) -> const auto& { return b.weighted.indices; });
  join(posed.rows, 0, [](const FixedRows& b) -> const auto& { return b.posed.rows; });
  join(posed.at, 0, [](const FixedRows& b) -> const auto& { return b.posed.at; });
}

std::size_t FixedRows::bytes() const {
  const auto of = [](const auto&... vectors) {
    return ((vectors.size() * sizeof(vectors[0])) + ...);
  };
  return of(single.rows, single.tiles, single.u, single.v, weighted.rows, weighted.offsets,
            weighted.indices, weighted.weights, posed.rows, posed.at);
}

}  // namespace limitsurf
